#pragma once
// A channel of many frames in one picture, with the same colours for all.

#include "host/output/pictures/canvas.h"
#include "host/output/sheets/thumbnail.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim {

// One channel of one sensor over time.
struct FilmStrip {
  std::string sensor;
  std::vector<std::uint32_t> frames;
  std::vector<Thumbnail> thumbnails; // of these, of one channel and size; at least one
};

// The colours that all of a strip's frames have.
Colouring colouring_of(const FilmStrip &strip);

// Frame by frame in rows; `frame_count` is how many the run has, of which the strip may show some.
Canvas draw_contact_sheet(const FilmStrip &strip, std::uint32_t frame_count);

} // namespace pmdsim
