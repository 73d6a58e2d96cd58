#pragma once
// The textures of a glTF file, each image decoded when it is first asked for, and only once.

#include "engine/model/scene.h"
#include "host/input/gltf/data/buffers.h"

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace tinygltf {
class Model;
}

namespace pmdsim {

// Of all images of a file that are used, together: 2 GiB decoded.
inline constexpr std::size_t max_file_texels = std::size_t{1} << 27;

struct GltfTexture {
  std::shared_ptr<const Texture> texels;
  float least_alpha = 1.0f; // of all texels
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  TextureFilter filter = TextureFilter::linear;
};

class GltfTextures {
public:
  // `document` has passed the glTF schema and the check of its references; `model` has its buffers' bytes.
  GltfTextures(const nlohmann::json &document, std::shared_ptr<const tinygltf::Model> model,
               std::filesystem::path file);

  // /textures/`texture`, which exists. Throws Error (input).
  GltfTexture operator[](std::size_t texture);

private:
  struct Image {
    std::shared_ptr<const Texture> texels;
    float least_alpha;
  };

  const Image &image(std::size_t index);
  Image decoded(std::size_t index);
  void set_sampler(const nlohmann::json &texture, GltfTexture &result) const;

  nlohmann::json textures_, images_, samplers_;
  std::shared_ptr<const tinygltf::Model> model_;
  Place root_;
  std::map<std::size_t, Image> decoded_;
  std::size_t left_texels_ = max_file_texels;
};

} // namespace pmdsim
