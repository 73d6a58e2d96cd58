#include "host/input/array/image_array.h"

#include "host/input/array/array_formats.h"
#include "host/input/file/input_file.h"
#include "host/input/file/memory_request.h"
#include "host/input/frame/frame_file.h"
#include "host/input/image/image_pixels.h"

#include <fmt/format.h>
#include <limits>
#include <type_traits>

namespace pmdsim {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 32;
constexpr std::string_view exr_magic("\x76\x2f\x31\x01", 4), h5_magic("\x89HDF\r\n\x1a\n", 8),
    png_magic("\x89PNG\r\n\x1a\n", 8), zip_magic("PK\x03\x04", 4);

ImageArrays frame_arrays(const std::filesystem::path &file,
                         const std::function<bool(std::string_view)> &wanted) {
  const ReadFrame frame = read_frame(file);
  ImageArrays read{"EXR or HDF5"};
  for (const ReadChannel &channel : frame.channels) {
    read.names.push_back(channel.name);
    if (!wanted(channel.name))
      continue;
    require_memory(frame.resolution.x * std::size_t{frame.resolution.y} * sizeof(double), Place{file},
                   "the channel " + channel.name);
    std::visit(
        [&](const auto &values) {
          using Value = std::decay_t<decltype(values)>::value_type;
          constexpr bool whole = std::is_integral_v<Value>;
          read.arrays.push_back({channel.name,
                                 frame.resolution,
                                 {values.begin(), values.end()},
                                 whole,
                                 whole ? std::numeric_limits<Value>::max() : 0.0});
        },
        channel.values);
  }
  return read;
}

ImageArrays single(const char *format, ImageArray array) {
  ImageArrays read{format};
  read.arrays.push_back(std::move(array));
  return read;
}

} // namespace

ImageArray png_array(std::string_view bytes, const Place &place) {
  constexpr std::size_t most_pixels = std::size_t{max_image_side} * max_image_side;
  const ImagePixels image = decoded_image(
      {reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size()}, most_pixels, place);
  ImageArray array{"", image.size, {}, true, image.component_bytes == 2 ? 65535.0 : 255.0};
  const auto component = [&](std::size_t pixel, std::size_t colour) {
    const unsigned char *at = &image.rgba[(4 * pixel + colour) * image.component_bytes];
    return image.component_bytes == 2 ? 256u * at[0] + at[1] : unsigned{at[0]};
  };
  const std::size_t pixels = std::size_t{image.size.x} * image.size.y;
  require_memory(pixels * sizeof(double), place, "its numbers");
  array.values.reserve(pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    if (component(pixel, 0) != component(pixel, 1) || component(pixel, 0) != component(pixel, 2))
      throw input_error(place, "expected a grey image, of one number a pixel, found colours");
    array.values.push_back(component(pixel, 0));
  }
  return array;
}

ImageArrays read_image_arrays(const std::filesystem::path &file,
                              const std::function<bool(std::string_view)> &wanted) {
  const Place place{file};
  const std::string content = read_regular_file(file, max_bytes, place);
  if (content.starts_with(exr_magic) || content.starts_with(h5_magic))
    return frame_arrays(file, wanted);
  if (content.starts_with(npy_magic))
    return single("NPY", npy_array(content, place));
  if (content.starts_with(zip_magic))
    return npz_arrays(content, wanted, place);
  if (content.starts_with(png_magic))
    return single("PNG", png_array(content, place));
  if (content.find('\0') != std::string::npos)
    throw input_error(place, "expected an image as NPY, NPZ, EXR, HDF5, PNG or rows of numbers");
  return single("text", text_array(content, place));
}

} // namespace pmdsim
