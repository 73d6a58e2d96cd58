// The tree's boxes and the order of its walk.

#include "engine/shadow/occluders.h"

#include "tests/support/random_scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using Corners = std::array<glm::dvec3, 3>;

// Those with the corners' numbers as ids.
std::vector<shader::Occluder> occluders_of(const std::vector<Corners> &all_m) {
  std::vector<shader::Occluder> occluders;
  for (const Corners &corners_m : all_m) {
    shader::Occluder occluder{};
    const auto split = [](const glm::dvec3 &p, glm::vec4 &hi, glm::vec4 &lo) {
      hi = glm::vec4(p, 0.0);
      lo = glm::vec4(p - glm::dvec3(hi), 0.0);
    };
    split(corners_m[0], occluder.a_hi, occluder.a_lo);
    split(corners_m[1], occluder.b_hi, occluder.b_lo);
    split(corners_m[2], occluder.c_hi, occluder.c_lo);
    occluder.id = static_cast<std::uint32_t>(occluders.size());
    occluders.push_back(occluder);
  }
  return occluders;
}

std::vector<Corners> random_corners(Random &random, std::size_t count, double size_m) {
  std::vector<Corners> all_m;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 at = random.in_box({-2, -2, 0}, {2, 2, 4});
    all_m.push_back({at, at + size_m * random.unit_vector(), at + size_m * random.unit_vector()});
  }
  return all_m;
}

bool holds(const shader::TreeNode &node, const Corners &corners_m) {
  return std::ranges::all_of(corners_m, [&](const glm::dvec3 &p) {
    return node.low_x <= p.x && node.low_y <= p.y && node.low_z <= p.z && p.x <= node.high_x &&
           p.y <= node.high_y && p.z <= node.high_z;
  });
}

// Each occluder lies in one leaf, the leaves in the order of the occluders.
void check_leaves(const OccluderTree &tree, std::size_t count) {
  std::vector<int> times(count);
  for (const shader::Occluder &occluder : tree.occluders) {
    REQUIRE(occluder.id < count);
    ++times[occluder.id];
  }
  CHECK(times == std::vector<int>(count, 1));
  std::uint32_t next = 0;
  for (const shader::TreeNode &node : tree.nodes)
    if (node.occluder != shader::no_occluder)
      REQUIRE(node.occluder == next++);
  CHECK(next == count);
}

// Subtrees end where `skip` says, lie within one another, and their boxes hold whatever is below.
void check_nesting(const OccluderTree &tree, const std::vector<Corners> &all_m) {
  std::vector<std::uint32_t> above; // nodes whose subtrees the walk is in
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const shader::TreeNode &node = tree.nodes[i];
    while (!above.empty() && tree.nodes[above.back()].skip == i)
      above.pop_back();
    const bool is_leaf = node.occluder != shader::no_occluder;
    REQUIRE((is_leaf ? node.skip == i + 1 : node.skip > i + 1));
    REQUIRE(node.skip <= (above.empty() ? tree.nodes.size() : tree.nodes[above.back()].skip));
    above.push_back(i);
    if (is_leaf)
      for (const std::uint32_t a : above)
        REQUIRE(holds(tree.nodes[a], all_m[tree.occluders[node.occluder].id]));
  }
}

void check_tree(const std::vector<Corners> &all_m) {
  const OccluderTree tree = build_tree(occluders_of(all_m));
  check_leaves(tree, all_m.size());
  check_nesting(tree, all_m);
  CHECK(tree.nodes[0].skip == tree.nodes.size()); // a walk that misses the root ends at once
}

} // namespace

TEST_CASE("nothing makes an empty tree") {
  const OccluderTree tree = build_tree({});
  CHECK(tree.nodes.empty());
  CHECK(tree.occluders.empty());
}

TEST_CASE("a tree's walk meets every occluder once, and skips what it may") {
  Random random(51);
  for (const std::size_t count : {1u, 2u, 3u, 7u, 100u, 3000u})
    for (const double size_m : {1e-4, 0.1, 3.0})
      check_tree(random_corners(random, count, size_m));
}

TEST_CASE("occluders in the same place, without width or of very different sizes each have their leaf") {
  Random random(52);
  const Corners one = random_corners(random, 1, 0.5).front();
  check_tree(std::vector<Corners>(5000, one));
  std::vector<Corners> points_m, lines_m, sizes_m;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 at = random.in_box({-1, -1, 0}, {1, 1, 2});
    points_m.push_back({at, at, at});
    lines_m.push_back({at, at + glm::dvec3(0, 0, 1), at + glm::dvec3(0, 0, 0.5)});
    sizes_m.push_back(random_corners(random, 1, std::exp2(random.uniform(-40, 40))).front());
  }
  check_tree(points_m);
  check_tree(lines_m);
  check_tree(sizes_m);
  // Ever closer to one place: a tree that halves space gets deep.
  std::vector<Corners> series_m;
  for (int i = 0; i < 120; ++i)
    series_m.push_back({glm::dvec3(std::exp2(-i)), glm::dvec3(std::exp2(-i), 0, 0), glm::dvec3(0.0)});
  check_tree(series_m);
}

TEST_CASE("a tree over 100,000 occluders") {
  Random random(53);
  check_tree(random_corners(random, 100000, 0.02));
}

TEST_CASE("boxes part what lies apart: a walk along a line takes few steps") {
  Random random(54);
  const OccluderTree tree = build_tree(occluders_of(random_corners(random, 20000, 0.02)));
  std::size_t steps = 0;
  for (std::size_t at = 0; at < tree.nodes.size(); ++steps) {
    const shader::TreeNode &node = tree.nodes[at];
    const bool meets = node.low_x <= 0.1f && 0.1f <= node.high_x && node.low_y <= 0.2f && 0.2f <= node.high_y;
    at = meets ? at + 1 : node.skip;
  }
  CHECK(steps < tree.nodes.size() / 20);
}
