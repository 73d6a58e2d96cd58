#include "engine/surfaces/hemisphere_scan.h"

#include "engine/surfaces/line_parts.h"
#include "engine/surfaces/line_sight.h"

namespace pmdsim {

// The scan of a place; its storage serves the next.
class PlaceScan {
public:
  void run(const HemisphereScan &scene, const SurfaceFrame &frame, std::uint32_t lines,
           Sightings &sightings) {
    scene_ = &scene;
    lines_ = lines;
    see_vertices(frame);
    sort_into_lines();
    parts_.clear();
    sightings.line_ends.clear();
    for (std::uint32_t line = 0; line < lines; ++line) {
      scan(line);
      sightings.line_ends.push_back(static_cast<std::uint32_t>(parts_.size()));
    }
    parts_.finish(sightings);
  }

private:
  void see_vertices(const SurfaceFrame &frame) {
    const glm::vec3 x(frame.x), y(frame.y), z(frame.z), from(frame.from_m);
    const std::size_t count = scene_->x_m_.size();
    for (auto *coordinate : {&x_, &y_, &z_})
      coordinate->resize(count);
    first_line_.resize(count);
    is_below_.resize(count);
    const float lines_per_rad = static_cast<float>(lines_) / std::numbers::pi_v<float>;
    // What is written lies apart from what is read, which the compiler cannot know.
    const float *__restrict from_x = scene_->x_m_.data(), *__restrict from_y = scene_->y_m_.data(),
                            *__restrict from_z = scene_->z_m_.data();
    float *__restrict to_x = x_.data(), *__restrict to_y = y_.data(), *__restrict to_z = z_.data();
    std::int32_t *__restrict first_line = first_line_.data(), *__restrict is_below = is_below_.data();
    for (std::size_t i = 0; i < count; ++i) {
      const float dx = from_x[i] - from.x, dy = from_y[i] - from.y, dz = from_z[i] - from.z;
      const float along = y.x * dx + y.y * dy + y.z * dz, up = z.x * dx + z.y * dy + z.z * dz;
      to_x[i] = x.x * dx + x.y * dy + x.z * dz;
      to_y[i] = along;
      to_z[i] = up;
      is_below[i] = up < 0.0f ? 1 : 0;
      // The plane of a line goes on below, where a vertex is as its mirror image is above.
      const float angle = angle_of(up < 0.0f ? -along : along, std::abs(up));
      // Lines lie half a step after whole ones.
      first_line[i] = static_cast<std::int32_t>(0.5f * (2.0f * angle * lines_per_rad + 1.0f));
    }
  }

  // On which side of a line's plane a vertex is. Vertices alone decide it, so that triangles beside each
  // other agree on the edge that they share.
  bool is_beyond(std::uint32_t vertex, std::uint32_t line) const {
    return (static_cast<std::int32_t>(line) < first_line_[vertex]) != (is_below_[vertex] != 0);
  }

  void sort_into_lines() {
    if (of_line_.size() < lines_)
      of_line_.resize(lines_);
    for (std::vector<std::uint32_t> &of_line : of_line_)
      of_line.clear();
    for (std::uint32_t i = 0; i < scene_->triangles_.size(); ++i) {
      const auto &[a, b, c] = scene_->triangles_[i].vertices;
      const int below = is_below_[a] + is_below_[b] + is_below_[c];
      if (below == 3)
        continue;
      if (below == 0) {
        const auto [first, end] = std::minmax({first_line_[a], first_line_[b], first_line_[c]});
        for (std::int32_t line = first; line < end; ++line)
          of_line_[static_cast<std::size_t>(line)].push_back(i);
        continue;
      }
      for (std::uint32_t line = 0; line < lines_; ++line)
        if (const bool side = is_beyond(a, line); side != is_beyond(b, line) || side != is_beyond(c, line))
          of_line_[line].push_back(i);
    }
  }

  void scan(std::uint32_t line) {
    const double angle = std::numbers::pi * (line + 0.5) / lines_;
    cosine_ = static_cast<float>(std::cos(angle));
    sine_ = static_cast<float>(std::sin(angle));
    // The strip about a line, over pi: those of all lines are 2 / pi, and half of pi is what each sums to.
    const double strip = 2.0 * std::sin(0.5 * std::numbers::pi / lines_) * std::sin(angle);
    parts_.weight = static_cast<float>(strip / std::numbers::pi);
    sight_.clear();
    for (const std::uint32_t i : of_line_[line])
      add_triangle(i, line);
    sight_.for_each_run([&](const Stretch &stretch, const SeenRun &run) { add_run(stretch, run); });
  }

  void add_triangle(std::uint32_t number, std::uint32_t line) {
    const auto &[vertices, triangle] = scene_->triangles_[number];
    std::array<StretchEnd, 2> ends;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      if (is_beyond(vertices[i], line) != is_beyond(vertices[k], line))
        ends[found++] = vertices[i] < vertices[k] ? meet(vertices, i, k) : meet(vertices, k, i);
    }
    if (found != 2)
      return;
    const auto is_there = [&](const CornerWeights &weights) {
      return is_there_at(scene_->scene_, triangle, weights);
    };
    const Stretch stretch{ends[0], ends[1], triangle, side_of(vertices)};
    if (scene_->scene_.is_masked(triangle))
      sight_.add(stretch, scene_->lowest_m_, is_there);
    else
      sight_.add(stretch, scene_->lowest_m_, [](const CornerWeights &) { return true; });
  }

  // Where the edge between two corners meets the line's plane.
  StretchEnd meet(const std::array<std::uint32_t, 3> &vertices, std::size_t i, std::size_t k) const {
    const std::uint32_t a = vertices[i], b = vertices[k];
    const float before = cosine_ * z_[a] - sine_ * y_[a], after = cosine_ * z_[b] - sine_ * y_[b];
    const float t = before != after ? std::clamp(before / (before - after), 0.0f, 1.0f) : 0.5f;
    const glm::vec2 from(x_[a], cosine_ * y_[a] + sine_ * z_[a]), to(x_[b], cosine_ * y_[b] + sine_ * z_[b]);
    StretchEnd end{from + t * (to - from), glm::vec3(0.0f), 0.0f};
    end.weights[static_cast<glm::length_t>(i)] = 1.0f - t;
    end.weights[static_cast<glm::length_t>(k)] = t;
    return end;
  }

  // 0 where the front of a triangle is seen.
  std::uint8_t side_of(const std::array<std::uint32_t, 3> &vertices) const {
    const auto corner = [&](std::size_t i) {
      return glm::vec3(x_[vertices[i]], y_[vertices[i]], z_[vertices[i]]);
    };
    const glm::vec3 a = corner(0);
    return glm::dot(glm::cross(corner(1) - a, corner(2) - a), a) < 0.0f ? 0 : 1;
  }

  void add_run(const Stretch &stretch, const SeenRun &run) {
    const glm::vec2 way = run.to.at_m - run.from.at_m;
    const glm::vec3 of_way = run.to.weights - run.from.weights, of_from = run.from.weights;
    scene_->cuts_.along(
        stretch.triangle, {of_from.y, of_way.y}, {of_from.z, of_way.z},
        [&](std::uint32_t facet, float from, float to, const Linear &u, const Linear &v) {
          const std::size_t face = face_of(facet, stretch.side);
          if (scene_->reflects_[face] != 0)
            parts_.add({run.from.at_m, way, u, v, static_cast<std::uint32_t>(face), run.scale}, from, to);
        });
  }

  const HemisphereScan *scene_ = nullptr;
  std::uint32_t lines_ = 0;
  std::vector<float> x_, y_, z_; // of vertices, in the place's frame
  std::vector<std::int32_t> first_line_;
  std::vector<std::int32_t> is_below_;
  std::vector<std::vector<std::uint32_t>> of_line_;
  float cosine_ = 0.0f, sine_ = 0.0f; // of the angle between the surface and the line's half plane
  LineSight sight_;
  LineParts parts_;
};

HemisphereScan::HemisphereScan(const Scene &scene, const Elements &elements)
    : scene_(scene), cuts_(elements), edges_(elements, scene),
      lowest_m_(static_cast<float>(elements.clearance_m())) {
  for (const Facet &facet : elements.facets)
    for (const std::uint32_t element : facet.elements)
      reflects_.push_back(element != no_element ? 1 : 0);
  std::vector<std::uint32_t> numbers(scene.positions_m.size(), no_node);
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
    if (elements.roots[id] == no_node)
      continue;
    Corners corners{scene.triangles[id].vertices, id};
    for (std::uint32_t &vertex : corners.vertices) {
      std::uint32_t &number = numbers[vertex];
      if (number == no_node) {
        number = static_cast<std::uint32_t>(x_m_.size());
        const glm::vec3 position(scene.positions_m[vertex] - elements.origin_m);
        x_m_.push_back(position.x);
        y_m_.push_back(position.y);
        z_m_.push_back(position.z);
      }
      vertex = number;
    }
    triangles_.push_back(corners);
  }
}

void HemisphereScan::at(const SurfacePlace &place, double turn, std::uint32_t lines,
                        Sightings &sightings) const {
  thread_local PlaceScan scan;
  scan.run(*this, SurfaceFrame(place, edges_.best_turn(place, turn, lines)), lines, sightings);
}

} // namespace pmdsim
