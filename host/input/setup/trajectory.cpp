#include "host/input/setup/trajectory.h"

#include "host/input/file/input_file.h"
#include "host/input/schema/limits.h"
#include "host/input/setup/rotations.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <span>
#include <string_view>

namespace pmdsim {
namespace {

constexpr std::array<std::string_view, 8> names{"time_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"};
constexpr std::array<std::string_view, 8> ros_endings{"%time",         "position.x",    "position.y",
                                                      "position.z",    "orientation.x", "orientation.y",
                                                      "orientation.z", "orientation.w"};
constexpr std::array<std::string_view, 8> euroc_beginnings{"#timestamp", "p_RS_R_x", "p_RS_R_y", "p_RS_R_z",
                                                           "q_RS_x",     "q_RS_y",   "q_RS_z",   "q_RS_w"};
constexpr double nanoseconds = 1e-9; // ROS's and EuRoC's times
constexpr std::size_t kitti_values = 12;
constexpr double least_length = 0.99, largest_length = 1.01; // of a quaternion as files round them

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

// At commas; without, at runs of blanks.
std::vector<std::string_view> fields_of(std::string_view line, bool commas) {
  std::vector<std::string_view> fields;
  while (!line.empty() || fields.empty()) {
    const std::size_t end = std::min(line.find_first_of(commas ? "," : " \t"), line.size());
    fields.push_back(trimmed(line.substr(0, end)));
    if (commas && end + 1 == line.size())
      fields.emplace_back();
    line.remove_prefix(std::min(end + 1, line.size()));
    if (!commas)
      line = trimmed(line);
  }
  return fields;
}

// Which field of a line holds each of the eight values, and the unit of its time.
struct Columns {
  std::array<std::size_t, 8> of{0, 1, 2, 3, 4, 5, 6, 7};
  std::size_t count = 8; // of a line's fields
  bool commas = false;
  double seconds = 1.0;
};

// EuRoC's first line is a comment.
bool is_euroc_header(std::string_view line) { return line.starts_with(euroc_beginnings[0]); }

Columns columns_of(std::string_view header, const TextPlace &place) {
  const std::vector<std::string_view> fields = fields_of(header, true);
  const bool is_ros = std::ranges::any_of(fields, [](auto name) { return name == ros_endings[0]; });
  const bool is_euroc = is_euroc_header(header);
  const auto &expected = is_ros ? ros_endings : is_euroc ? euroc_beginnings : names;
  Columns columns{.count = fields.size(), .commas = true, .seconds = is_ros || is_euroc ? nanoseconds : 1.0};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto is_it = [&](std::string_view name) {
      return is_ros     ? name.ends_with(expected[i])
             : is_euroc ? name.starts_with(expected[i])
                        : name == expected[i];
    };
    const auto found = std::ranges::find_if(fields, is_it);
    if (found == fields.end()) {
      std::vector<std::string> unknown;
      for (const std::string_view field : fields)
        if (std::ranges::find(expected, field) == expected.end())
          unknown.emplace_back(field);
      const auto near = nearest_name(expected[i], unknown);
      throw input_error(place, fmt::format("missing column {}{}", expected[i],
                                           near ? ", expected it instead of " + in_quotes(*near) : ""));
    }
    columns.of[i] = static_cast<std::size_t>(found - fields.begin());
  }
  return columns;
}

void append(double time_s, const glm::dvec3 &position_m, const glm::dquat &rotation, const TextPlace &place,
            Trajectory &to) {
  if (!to.times_s.empty() && time_s <= to.times_s.back())
    throw input_error(place,
                      fmt::format("expected a time after {} s, found {} s", to.times_s.back(), time_s));
  if (to.times_s.size() == max_poses)
    throw input_error(place, fmt::format("expected at most {} poses", max_poses));
  to.times_s.push_back(time_s);
  to.positions_m.push_back(position_m);
  to.rotations.push_back(glm::normalize(rotation));
}

// Three rows of a 3 x 4 matrix, whose rotation may be rounded to six digits.
void append_kitti(const std::vector<std::string_view> &fields, const TextPlace &place, Trajectory &to) {
  constexpr double rounding = 1e-5;
  constexpr NumberRange range{-max_coordinate_m, max_coordinate_m};
  glm::dmat3 linear;
  glm::dvec3 position_m;
  auto field = fields.begin();
  for (glm::length_t row = 0; row < 3; ++row)
    for (glm::length_t column = 0; column < 4; ++column)
      (column < 3 ? linear[column][row] : position_m[row]) =
          number_of(*field++, "a pose's matrix", place, range);
  const auto rotation = rotation_of(linear);
  bool is_rotation = rotation.has_value();
  for (glm::length_t axis = 0; is_rotation && axis < 3; ++axis)
    is_rotation = glm::length((*rotation)[axis] - linear[axis]) <= rounding;
  if (!is_rotation)
    throw input_error(place, "expected three rows of a rotation and a translation, found a matrix that "
                             "scales, shears or mirrors");
  append(static_cast<double>(to.times_s.size()), position_m, glm::quat_cast(*rotation), place, to);
}

// `line` is without the blanks around it, and begins at `begin`.
void append_pose(std::string_view line, const Columns &columns, const TextPlace &begin, Trajectory &to) {
  const TextPlace place{begin.file, begin.line};
  const std::vector<std::string_view> fields = fields_of(line, columns.commas);
  if (fields.size() != columns.count)
    throw input_error(place, fmt::format("expected {} values, found {}", columns.count, fields.size()));
  if (!columns.commas && columns.count == kitti_values)
    return append_kitti(fields, place, to);
  std::array<double, 8> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_length = i >= 1 && i <= 3;
    const NumberRange range = is_length ? NumberRange{-max_coordinate_m, max_coordinate_m} : NumberRange{};
    const std::string_view field = fields[columns.of[i]];
    const auto before = static_cast<std::size_t>(field.data() - line.data());
    values[i] = number_of(field, names[i], {begin.file, begin.line, begin.column + before}, range);
  }
  const auto [time, x, y, z, qx, qy, qz, qw] = values;
  const glm::dquat rotation(qw, qx, qy, qz);
  const double length = std::hypot(std::hypot(qx, qy), std::hypot(qz, qw)), time_s = time * columns.seconds;
  if (!(length >= least_length && length <= largest_length))
    throw input_error(place, fmt::format("expected a quaternion of length 1, found {}", length));
  append(time_s, {x, y, z}, rotation, place, to);
}

bool is_comment(std::string_view line) { return line.empty() || line.starts_with('#'); }

} // namespace

Pose Trajectory::at(double time_s) const {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times_s, time_s) - times_s.begin());
  if (after == 0 || after == times_s.size()) {
    const std::size_t end = after == 0 ? 0 : after - 1;
    return {glm::mat3_cast(rotations[end]), positions_m[end]};
  }
  const std::size_t before = after - 1;
  const double share = (time_s - times_s[before]) / (times_s[after] - times_s[before]);
  return {glm::mat3_cast(glm::slerp(rotations[before], rotations[after], share)),
          glm::mix(positions_m[before], positions_m[after], share)};
}

Trajectory read_trajectory(const std::filesystem::path &file, const Place &named_at) {
  const std::string text = read_text_file(file, named_at);
  Trajectory trajectory;
  std::optional<Columns> columns;
  TextPlace place{file, 0};
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = trimmed(rest.substr(0, end));
    const auto blanks = static_cast<std::size_t>(line.data() - rest.data());
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++place.line;
    if (!columns && is_euroc_header(line)) {
      columns = columns_of(line, place);
      continue;
    }
    if (is_comment(line))
      continue;
    if (columns) {
      append_pose(line, *columns, {file, place.line, blanks + 1}, trajectory);
    } else if (line.find(',') != std::string_view::npos) {
      columns = columns_of(line, place);
    } else {
      columns = Columns{.count = fields_of(line, false).size() == kitti_values ? kitti_values : 8};
      append_pose(line, *columns, {file, place.line, blanks + 1}, trajectory);
    }
  }
  if (trajectory.times_s.empty())
    throw input_error(Place{file}, "expected at least one pose");
  return trajectory;
}

} // namespace pmdsim
