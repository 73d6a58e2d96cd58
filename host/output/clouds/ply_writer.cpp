#include "host/output/clouds/ply_writer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes go to the file as they lie in memory");

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

template <class Value>
void append(std::string &bytes, Value value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  bytes.append(raw.data(), raw.size());
}

// The frame's channels that points have, by the names of properties.
std::vector<const Channel *> scalars_of(const PointCloud &cloud) {
  std::vector<const Channel *> scalars;
  const auto add = [&](const Channel *channel) {
    if (channel && std::ranges::find(scalars, channel) == scalars.end())
      scalars.push_back(channel);
  };
  add(first_of(cloud.channels(), "amplitude"));
  add(&cloud.distance());
  for (const char *quantity :
       {"range_m", "deformation_mm", "correction_mm", "normal_error_mm", "status", "object_id"})
    add(first_of(cloud.channels(), quantity));
  return scalars;
}

bool is_id(const Channel &channel) {
  return std::holds_alternative<std::span<const std::uint32_t>>(channel.values);
}

// Text from a setup must not end the comment's line.
std::string quoted(const std::string &text) {
  return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string pose_text(const Pose &pose) {
  std::string text;
  for (glm::length_t row = 0; row < 3; ++row)
    text += fmt::format(" {} {} {} {}", pose.rotation[0][row], pose.rotation[1][row], pose.rotation[2][row],
                        pose.translation_m[row]);
  return text;
}

std::string comments_of(const PointCloud &cloud, const FrameLabel &label) {
  std::string text = fmt::format(
      "comment pmdsim {}\n"
      "comment sensor {}, frame {}, {} s\n"
      "comment x y z: world frame of the poses (glTF's: right-handed, +Y up), metres; at {} along each "
      "pixel's ray, {}\n"
      "comment world_from_camera, 3 rows of 4 (camera: x right, y down, z forward):{}\n",
      PMDSIM_VERSION, quoted(label.sensor.name), label.frame, label.time_s, cloud.distance().name(),
      cloud.way_of_distances(), pose_text(label.sensor.world_from_camera));
  if (cloud.brightest())
    text += fmt::format("comment red green blue: square root of amplitude over {:.6g} W/(m^2 sr)\n",
                        *cloud.brightest());
  return text;
}

std::string header_of(const PointCloud &cloud, bool normals, const std::vector<const Channel *> &scalars,
                      const FrameLabel &label) {
  std::string text = "ply\nformat binary_little_endian 1.0\n" + comments_of(cloud, label);
  text += fmt::format("element vertex {}\n", cloud.count());
  const auto add = [&](const char *type, const std::string &name) {
    text += fmt::format("property {} {}\n", type, name);
  };
  for (const char *name : {"x", "y", "z"})
    add("float", name);
  if (normals)
    for (const char *name : {"nx", "ny", "nz"})
      add("float", name);
  for (const char *name : {"red", "green", "blue"})
    add("uchar", name);
  for (const Channel *scalar : scalars)
    add(is_id(*scalar) ? "uint" : "float", scalar->quantity);
  for (const char *name : {"row", "column"})
    add("uint", name);
  return text + "end_header\n";
}

} // namespace

void write_ply(OutputFile &file, const PointCloud &cloud, std::span<const glm::vec3> normals,
               const FrameLabel &label) {
  const std::vector<const Channel *> scalars = scalars_of(cloud);
  const std::uint32_t columns = cloud.channels().resolution.x;
  std::string bytes = header_of(cloud, !normals.empty(), scalars, label);
  cloud.for_each([&](std::size_t pixel, const glm::dvec3 &point_m) {
    for (glm::length_t i = 0; i < 3; ++i)
      append(bytes, static_cast<float>(point_m[i]));
    if (!normals.empty())
      for (glm::length_t i = 0; i < 3; ++i)
        append(bytes, normals[pixel][i]);
    for (const double level : cloud.colour(pixel))
      append(bytes, static_cast<std::uint8_t>(std::lround(255.0 * level)));
    for (const Channel *scalar : scalars)
      std::visit([&](const auto &values) { append(bytes, values[pixel]); }, scalar->values);
    append(bytes, static_cast<std::uint32_t>(pixel / columns));
    append(bytes, static_cast<std::uint32_t>(pixel % columns));
    if (bytes.size() >= buffer_bytes) {
      file.write(bytes);
      bytes.clear();
    }
  });
  file.write(bytes);
}

} // namespace pmdsim
