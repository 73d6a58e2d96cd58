#pragma once
// The textures of a glTF file, each image decoded when it is first asked for, and only once.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/document.h"

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace tinygltf {
class Model;
}

namespace pmdsim {

// The limit of all images of a file that are used, together: 2 GiB decoded.
inline constexpr std::size_t max_file_texels = std::size_t{1} << 27;

class GltfTextures {
public:
  // `document` has passed the glTF schema and the check of its references; `model` has its buffers' bytes.
  GltfTextures(const nlohmann::json &document, std::shared_ptr<const tinygltf::Model> model,
               std::filesystem::path file, UriFiles files);

  // Gives `paint` /textures/`texture`, which exists, as its sampler says. Returns the least alpha of all
  // texels. Throws Error (input).
  float add(std::size_t texture, Paint &paint);

private:
  struct Image {
    std::shared_ptr<const Texture> texels;
    float least_alpha;
  };

  const Image &image(std::size_t index);
  Image decoded(std::size_t index);

  nlohmann::json textures_, images_, samplers_;
  std::shared_ptr<const tinygltf::Model> model_;
  Place root_;
  UriFiles files_;
  std::map<std::size_t, Image> decoded_;
  std::size_t left_texels_ = max_file_texels;
  std::size_t left_bytes_ = max_gltf_file_bytes; // of images' files
};

} // namespace pmdsim
