#include "host/input/gltf/cameras.h"

#include <numbers>

namespace pmdsim {
namespace {

using nlohmann::json;

std::optional<double> number_in(const json &camera, const char *pointer) {
  const json::json_pointer place(pointer);
  return camera.contains(place) && camera.at(place).is_number()
             ? std::optional(camera.at(place).get<double>())
             : std::nullopt;
}

std::optional<GltfPerspective> camera_of(const json &camera) {
  const auto vertical_rad = number_in(camera, "/perspective/yfov");
  if (!vertical_rad || !(*vertical_rad > 0.0 && *vertical_rad < std::numbers::pi))
    return std::nullopt;
  auto ratio = number_in(camera, "/perspective/aspectRatio");
  if (ratio && !(*ratio > 0.0))
    ratio.reset();
  return GltfPerspective{*vertical_rad, ratio};
}

} // namespace

std::vector<std::optional<GltfPerspective>> gltf_cameras(const json &document) {
  std::vector<std::optional<GltfPerspective>> cameras;
  if (document.contains("cameras") && document.at("cameras").is_array())
    for (const json &camera : document.at("cameras"))
      cameras.push_back(camera_of(camera));
  return cameras;
}

} // namespace pmdsim
