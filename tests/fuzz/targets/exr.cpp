// Frames as OpenEXR, from memory.

#include "tests/fuzz/target.h"

#include "host/input/frame/frame_bytes.h"
#include "host/input/words/utf8.h"

using namespace pmdsim;

FUZZ_TARGET(exr) {
  static const std::filesystem::path file = "frame.exr";
  fuzz::accepts([&] {
    for (const ReadChannel &channel : read_exr({file, std::string(fuzz::text_of(data, size))}).channels)
      if (!is_utf8(channel.name))
        throw std::logic_error("a channel's name is not UTF-8");
  });
  return 0;
}
