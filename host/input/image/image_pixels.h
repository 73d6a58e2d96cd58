#pragma once
// PNG and JPEG images, untrusted, as the numbers that they store and as the light that these mean.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

inline constexpr std::uint32_t max_image_side = 16384;

// RGBA as stored, before any transfer function; row-major, row 0 at the top. An opaque image's alpha is the
// largest number.
struct ImagePixels {
  glm::uvec2 size{0, 0};
  std::size_t component_bytes = 1;   // 1, or 2 with the more significant byte first
  std::vector<unsigned char> rgba{}; // size.x * size.y * 4 components
};

// The pixels of an image, whose first bytes tell its format. Colour profiles, gamma and EXIF orientation are
// ignored, as glTF demands. Throws Error (input) at `place`, before anything is allocated where the header
// states more than max_image_side a side or `max_pixels`.
ImagePixels decoded_image(std::span<const unsigned char> bytes, std::size_t max_pixels, const Place &place);

// A component as a share of the largest number, 0 ... 1, before any transfer function. `component` counts
// those of all pixels: 4 * pixel + 0 is red.
double stored_share(const ImagePixels &pixels, std::size_t component);

// The sRGB transfer function (IEC 61966-2-1), from 0 ... 1 as stored to linear 0 ... 1.
double linear_from_srgb(double stored);

// Red, green and blue go through the transfer function in double; alpha is linear as stored.
Texture linear_texture(const ImagePixels &pixels);

} // namespace pmdsim
