// Frames as HDF5, from memory.

#include "tests/fuzz/target.h"

#include "host/input/frame/frame_bytes.h"

using namespace pmdsim;

FUZZ_TARGET(hdf5) {
  static const std::filesystem::path file = "frame.h5";
  fuzz::accepts(
      [&] {
        read_h5({file, std::string(fuzz::text_of(data, size))});
      },
      {ExitCode::input, ExitCode::out_of_memory}); // of what a damaged file says that it has
  return 0;
}
