#pragma once
// PNG that moves (APNG), which browsers and most viewers show; others show its first image.

#include "host/output/files/output_file.h"
#include "host/output/pictures/canvas.h"

#include <cstdint>
#include <string>

namespace pmdsim {

// A canvas is added at a time, so that one of them is in memory. The animation repeats without end.
// Throws Error (output).
class AnimatedPng {
public:
  // `frames` of them come, each shown for `frame_ms`.
  AnimatedPng(OutputFile &file, std::uint32_t frames, std::uint16_t frame_ms);

  // All are of the first one's size.
  void add(const Canvas &canvas);
  // After the last.
  void end();

private:
  void write_chunk(const std::string &type, const std::string &content);
  void write_control(const std::string &header);

  OutputFile &file_;
  std::uint32_t frames_, added_ = 0, sequence_ = 0;
  std::uint16_t frame_ms_;
  std::string header_; // IHDR's content
};

} // namespace pmdsim
