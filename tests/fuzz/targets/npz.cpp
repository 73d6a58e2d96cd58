// NumPy's archives and arrays, from memory.

#include "tests/fuzz/target.h"

#include "host/input/array/array_formats.h"

using namespace pmdsim;

FUZZ_TARGET(npz) {
  const std::string_view bytes = fuzz::text_of(data, size);
  const Place place{"image.npz"};
  if (bytes.starts_with(npy_magic))
    fuzz::accepts([&] { npy_array(bytes, place); });
  else
    fuzz::accepts([&] {
      npz_arrays(
          bytes, [](std::string_view name) { return name != "coverage"; }, place);
    });
  return 0;
}
