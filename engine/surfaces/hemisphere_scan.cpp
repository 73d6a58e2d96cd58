#include "engine/surfaces/hemisphere_scan.h"

#include "engine/model/instruction_sets.h"
#include "engine/surfaces/surface_paint.h"

#include <algorithm>
#include <utility>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::ScanLoops, scan_loops)

namespace pmdsim {
namespace {

constexpr std::size_t room = 16;           // that vectors need behind the last value
constexpr std::uint32_t vector_bits = 512; // at most: sums are the same with any

// The triangles of a scene that have an area.
std::vector<std::uint32_t> triangles_of(const Elements &elements) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t id = 0; id < elements.roots.size(); ++id)
    if (elements.roots[id] != no_node)
      triangles.push_back(id);
  return triangles;
}

} // namespace

// The scan of a place; its storage serves the next.
class PlaceScan {
public:
  void run(const HemisphereScan &scan, const SurfaceFrame &frame, std::uint32_t lines,
           const std::function<void(const SeenLine &)> &visit) {
    const ScanScene &scene = scan.board_;
    reserve(scene);
    scan.loops_.see_vertices(scene, board_frame(frame, lines), vertices_);
    met_count_ = scan.loops_.find_triangles(scene, vertices_, met_);
    sort_into_lines(scene, lines);
    weigh_lines(lines);
    SeenLine seen;
    seen.bins = &scene.bins;
    for (std::uint32_t line = 0; line < lines; ++line) {
      const double angle = std::numbers::pi * (line + 0.5) / lines;
      const std::uint32_t from = line_starts_[line];
      const LineTask task{of_lines_.data() + from,
                          line_starts_[line + 1] - from,
                          static_cast<std::int32_t>(line),
                          static_cast<float>(std::cos(angle)),
                          static_cast<float>(std::sin(angle)),
                          static_cast<float>(strips_[line] / std::numbers::pi)};
      seen.cosine = task.cosine;
      seen.sine = task.sine;
      scan.loops_.see_line(scene, vertices_, task, stretches_, seen);
      visit(seen);
    }
  }

private:
  static ScanFrame board_frame(const SurfaceFrame &frame, std::uint32_t lines) {
    ScanFrame made{};
    for (glm::length_t i = 0; i < 3; ++i) {
      made.from_m[i] = static_cast<float>(frame.from_m[i]);
      made.x[i] = static_cast<float>(frame.x[i]);
      made.y[i] = static_cast<float>(frame.y[i]);
      made.z[i] = static_cast<float>(frame.z[i]);
    }
    made.lines = lines;
    return made;
  }

  void reserve(const ScanScene &scene) {
    const std::size_t vertices = scene.vertices + room, triangles = scene.triangles + room;
    if (codes_.size() < vertices) {
      coordinates_.resize(3 * vertices);
      codes_.resize(vertices);
      vertices_ = {coordinates_.data(), coordinates_.data() + vertices, coordinates_.data() + 2 * vertices,
                   codes_.data()};
    }
    if (met_values_.size() < 3 * triangles) {
      met_values_.resize(3 * triangles);
      met_ = {met_values_.data(), met_values_.data() + triangles, met_values_.data() + 2 * triangles};
      stretch_values_.resize(stretch_floats * triangles);
      stretch_integers_.resize(stretch_integers * triangles);
      float *values = stretch_values_.data();
      const auto next = [&] { return std::exchange(values, values + triangles); };
      std::int32_t *integers = stretch_integers_.data();
      const auto next_integers = [&] { return std::exchange(integers, integers + triangles); };
      stretches_ = {next(), next(), next(),          next(),          next(),          next(),
                    next(), next(), next_integers(), next_integers(), next_integers(), next_integers()};
    }
  }

  // What each line counts: the integral of the sine of the angle over the strip about it, all of which are 2,
  // as half of pi is what each line sums to. What changes from line to line is taken to be a parabola through
  // neighbours, as light changes much near the horizon, where it comes from near surfaces.
  void weigh_lines(std::uint32_t lines) {
    if (strips_.size() == lines)
      return;
    const double step = std::numbers::pi / lines, half = 0.5 * step;
    strips_.assign(lines, 0.0);
    for (std::uint32_t i = 0; i < lines; ++i) {
      const double angle = step * (i + 0.5), sine = std::sin(angle), cosine = std::cos(angle);
      strips_[i] += 2.0 * std::sin(half) * sine;
      if (lines < 3)
        continue;
      // The first and the second moment of the sine about the strip's middle, over powers of the step.
      const double first = 2.0 * cosine * (std::sin(half) - half * std::cos(half)) / step;
      const double second =
          2.0 * sine * (half * half * std::sin(half) + 2.0 * half * std::cos(half) - 2.0 * std::sin(half)) /
          (step * step);
      const std::uint32_t middle = std::clamp(i, 1u, lines - 2);
      const double from_middle = static_cast<double>(i) - static_cast<double>(middle);
      strips_[middle - 1] += (from_middle - 0.5) * first + 0.5 * second;
      strips_[middle] += -2.0 * from_middle * first - second;
      strips_[middle + 1] += (from_middle + 0.5) * first + 0.5 * second;
    }
  }

  // Visits (line, triangle) of all that meet.
  template <class Visit>
  void for_each_meeting(const ScanScene &scene, std::uint32_t lines, const Visit &visit) const {
    for (std::uint32_t k = 0; k < met_count_; ++k) {
      const std::int32_t i = met_.triangle[k];
      if (met_.first_line[k] >= 0) {
        for (std::int32_t line = met_.first_line[k]; line < met_.end_line[k]; ++line)
          visit(static_cast<std::uint32_t>(line), i);
        continue;
      }
      const auto is_beyond = [&](std::size_t corner, std::uint32_t line) {
        const std::int32_t code = codes_[static_cast<std::size_t>(scene.corners[corner][i])];
        return (static_cast<std::int32_t>(line) < code >> 1) != ((code & 1) != 0);
      };
      for (std::uint32_t line = 0; line < lines; ++line)
        if (const bool side = is_beyond(0, line); side != is_beyond(1, line) || side != is_beyond(2, line))
          visit(line, i);
    }
  }

  void sort_into_lines(const ScanScene &scene, std::uint32_t lines) {
    line_starts_.assign(lines + 1, 0);
    for_each_meeting(scene, lines, [&](std::uint32_t line, std::int32_t) { ++line_starts_[line + 1]; });
    for (std::uint32_t line = 0; line < lines; ++line)
      line_starts_[line + 1] += line_starts_[line];
    of_lines_.resize(line_starts_.back() + room);
    std::fill_n(of_lines_.end() - room, room, 0);
    next_.assign(line_starts_.begin(), line_starts_.end());
    for_each_meeting(scene, lines, [&](std::uint32_t line, std::int32_t i) { of_lines_[next_[line]++] = i; });
  }

  std::vector<float> coordinates_, stretch_values_;
  std::vector<std::int32_t> codes_, stretch_integers_;
  ScanVertices vertices_{};
  Stretches stretches_{};
  std::vector<std::int32_t> met_values_;
  MetTriangles met_{};
  std::uint32_t met_count_ = 0;
  std::vector<std::int32_t> of_lines_; // triangles, line by line
  std::vector<std::uint32_t> line_starts_, next_;
  std::vector<double> strips_; // of lines, as many as there were at the last place
};

HemisphereScan::HemisphereScan(const Scene &scene, const Elements &elements, std::uint32_t bins)
    : edges_(elements, scene), triangles_(triangles_of(elements)),
      cells_(elements, triangles_), cutouts_{scene, triangles_}, loops_(widest_scan_loops(vector_bits)) {
  std::vector<std::int32_t> numbers(scene.positions_m.size(), -1);
  bool any_masked = false;
  for (const std::uint32_t id : triangles_) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = scene.triangles[id].vertices[i];
      if (numbers[vertex] < 0) {
        numbers[vertex] = static_cast<std::int32_t>(x_m_.size());
        const glm::vec3 position(scene.positions_m[vertex] - elements.origin_m);
        x_m_.push_back(position.x);
        y_m_.push_back(position.y);
        z_m_.push_back(position.z);
      }
      corners_[i].push_back(numbers[vertex]);
    }
    is_masked_.push_back(scene.is_masked(id) ? 1 : 0);
    any_masked = any_masked || scene.is_masked(id);
  }
  make_bins(bins);
  board_.vertices = static_cast<std::uint32_t>(x_m_.size());
  board_.triangles = static_cast<std::uint32_t>(triangles_.size());
  for (auto *coordinate : {&x_m_, &y_m_, &z_m_})
    coordinate->resize(coordinate->size() + room);
  for (std::size_t i = 0; i < 3; ++i) {
    corners_[i].resize(corners_[i].size() + room);
    board_.corners[i] = corners_[i].data();
  }
  board_.x_m = x_m_.data();
  board_.y_m = y_m_.data();
  board_.z_m = z_m_.data();
  cells_.show(board_);
  board_.dark_face = static_cast<std::int32_t>(2 * elements.facets.size());
  board_.lowest_m = static_cast<float>(elements.clearance_m());
  if (any_masked) {
    board_.is_masked = is_masked_.data();
    board_.is_there_of = &cutouts_;
    board_.is_there = [](const void *of, std::int32_t triangle, float u, float v) {
      const auto &[masks, ids] = *static_cast<const Cutouts *>(of);
      const CornerWeights weights(1.0 - static_cast<double>(u) - static_cast<double>(v), u, v);
      return is_there_at(masks, ids[static_cast<std::size_t>(triangle)], weights);
    };
  }
}

void HemisphereScan::make_bins(std::uint32_t bins) {
  const std::uint32_t count = std::clamp((bins + 15) / 16 * 16, 16u, std::uint32_t{most_bins});
  const double width = std::numbers::pi / count;
  for (std::size_t i = 0; i < count + room; ++i) {
    const double angle = width * (static_cast<double>(i) + 0.5);
    bin_x_.push_back(static_cast<float>(std::cos(angle)));
    bin_y_.push_back(static_cast<float>(std::sin(angle)));
    bin_cotangent_.push_back(static_cast<float>(1.0 / std::tan(angle)));
  }
  board_.bins = {count, bin_x_.data(), bin_y_.data(), bin_cotangent_.data()};
}

SurfaceFrame HemisphereScan::frame(const SurfacePlace &place, double turn, std::uint32_t lines) const {
  return SurfaceFrame(place, edges_.best_turn(place, turn, lines));
}

void HemisphereScan::at(const SurfaceFrame &frame, std::uint32_t lines,
                        const std::function<void(const SeenLine &)> &visit) const {
  thread_local PlaceScan scan;
  scan.run(*this, frame, lines, visit);
}

} // namespace pmdsim
