#include "host/input/gltf/material/textures.h"

#include "host/input/file/input_file.h"
#include "host/input/file/memory_request.h"
#include "host/input/gltf/data/accessor.h"
#include "host/input/gltf/data/buffers.h"
#include "host/input/gltf/document.h"
#include "host/input/image/image_pixels.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <tiny_gltf.h>

namespace pmdsim {

using nlohmann::json;

namespace {

// The source of a texture that PNG or JPEG images can give.
std::size_t source_of(const json &texture, const Place &place) {
  if (texture.contains("source"))
    return texture.at("source").get<std::size_t>();
  const json extensions = texture.value("extensions", json::object());
  if (extensions.empty())
    throw input_error(place, "missing key \"source\"");
  throw input_error(place, fmt::format("the image is in {}, which is not supported (expected a \"source\" in "
                                       "PNG or JPEG)",
                                       in_quotes(extensions.begin().key())));
}

// `max_bytes`: of a file.
Bytes bytes_of_uri(const std::string &uri, UriFiles files, std::size_t max_bytes, const Place &place) {
  if (!uri.starts_with("data:")) {
    const std::string bytes = read_regular_file(file_of_uri(uri, files, place), max_bytes, place);
    require_memory(bytes.size(), place, "the image's file");
    return {bytes.begin(), bytes.end()};
  }
  Bytes bytes;
  std::string media_type;
  const bool is_image = uri.starts_with("data:image/png;") || uri.starts_with("data:image/jpeg;");
  if (!is_image || !tinygltf::DecodeDataURI(&bytes, media_type, uri, 0, false))
    throw input_error(place, "expected a base64 data URI of image/png or image/jpeg");
  return bytes;
}

Wrap wrap_of(const json &sampler, const char *key) {
  const int wrap = sampler.value(key, TINYGLTF_TEXTURE_WRAP_REPEAT);
  if (wrap == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE)
    return Wrap::clamp;
  return wrap == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

} // namespace

GltfTextures::GltfTextures(const json &document, std::shared_ptr<const tinygltf::Model> model,
                           std::filesystem::path file, UriFiles files)
    : textures_(document.value("textures", json::array())), images_(document.value("images", json::array())),
      samplers_(document.value("samplers", json::array())), model_(std::move(model)), root_{std::move(file)},
      files_(files) {}

float GltfTextures::add(std::size_t index, Paint &paint) {
  const json &texture = textures_.at(index);
  const Image &source = image(source_of(texture, root_ / "textures" / index));
  paint.texture = source.texels;
  if (texture.contains("sampler")) {
    const json &sampler = samplers_.at(texture.at("sampler").get<std::size_t>());
    paint.wrap_u = wrap_of(sampler, "wrapS");
    paint.wrap_v = wrap_of(sampler, "wrapT");
    if (sampler.value("magFilter", TINYGLTF_TEXTURE_FILTER_LINEAR) == TINYGLTF_TEXTURE_FILTER_NEAREST)
      paint.filter = TextureFilter::nearest;
  }
  return source.least_alpha;
}

const GltfTextures::Image &GltfTextures::image(std::size_t index) {
  const auto known = decoded_.find(index);
  return known != decoded_.end() ? known->second : decoded_.emplace(index, decoded(index)).first->second;
}

GltfTextures::Image GltfTextures::decoded(std::size_t index) {
  const json &image = images_.at(index);
  const Place place = root_ / "images" / index;
  if (image.contains("uri") == image.contains("bufferView"))
    throw input_error(place, "expected either \"uri\" or \"bufferView\"");
  Bytes own;
  std::span<const unsigned char> bytes;
  if (image.contains("uri"))
    bytes = own = bytes_of_uri(image.at("uri").get<std::string>(), files_, left_bytes_, place / "uri");
  else
    bytes = bytes_of_view(*model_, image.at("bufferView").get<std::size_t>(), root_);
  left_bytes_ -= own.size();
  const ImagePixels pixels = decoded_image(bytes, left_texels_, place);
  require_memory(std::size_t{pixels.size.x} * pixels.size.y * sizeof(glm::vec4), place, "its light");
  auto texels = std::make_shared<const Texture>(linear_texture(pixels));
  left_texels_ -= texels->texels.size();
  const float least_alpha = std::ranges::min(texels->texels, {}, &glm::vec4::a).a; // an image has a texel
  return {std::move(texels), least_alpha};
}

} // namespace pmdsim
