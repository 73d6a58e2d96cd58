// Rows of numbers as text.

#include "tests/fuzz/target.h"

#include "host/input/array/array_formats.h"

using namespace pmdsim;

FUZZ_TARGET(text_array) {
  const std::string_view text = fuzz::text_of(data, size);
  if (text.find('\0') == text.npos) // else it is no text
    fuzz::accepts([&] { text_array(text, Place{"image.csv"}); });
  return 0;
}
