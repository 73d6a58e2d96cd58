// Frames as HDF5, from memory.

#include "tests/fuzz/target.h"

#include "host/input/frame/frame_bytes.h"

using namespace pmdsim;

FUZZ_TARGET(hdf5) {
  static const std::filesystem::path file = "frame.h5";
  fuzz::accepts([&] { read_h5({file, std::string(fuzz::text_of(data, size))}); });
  return 0;
}
