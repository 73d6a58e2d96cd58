// A library of another version, which the Python package has to refuse.

extern "C" __attribute__((visibility("default"))) int pmdsim_abi();

int pmdsim_abi() { return 99; }
