#include "host/library/pmdsim.h"

const char *pmdsim_version(void) { return PMDSIM_VERSION; }
int pmdsim_abi(void) { return PMDSIM_ABI; }
