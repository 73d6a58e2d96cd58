// Images of numbers to correct, whatever holds them: NPY, NPZ, EXR, HDF5, PNG or text.

#include "tests/fuzz/target.h"

#include "host/input/array/image_array.h"

using namespace pmdsim;

FUZZ_TARGET(array) {
  const std::filesystem::path file = fuzz::write_file("image.bin", fuzz::text_of(data, size));
  fuzz::accepts([&] { read_image_arrays(file, [](std::string_view name) { return name != "coverage"; }); },
                {ExitCode::input, ExitCode::out_of_memory}); // of what a damaged HDF5 file says that it has
  return 0;
}
