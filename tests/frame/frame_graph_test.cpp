// The list of a frame's passes refuses what could not work.

#include "engine/frame/frame_graph.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace pmdsim;

namespace {

Pass pass(Resources reads, Resources writes) {
  return {.name = "test", .reads = reads, .writes = writes, .record = [](const Recording &) {}};
}

} // namespace

TEST_CASE("a pass that reads what none has written is refused") {
  FrameGraph graph;
  CHECK_THROWS_AS(graph.add_before(pass(ids, points)), std::logic_error);
  CHECK_NOTHROW(graph.add_before(pass(no_resource, ids)));
  CHECK_NOTHROW(graph.add_before(pass(ids, points)));
  CHECK_THROWS_AS(graph.add_to_window(pass(points | visibility_bits, sums)), std::logic_error);
  CHECK_NOTHROW(graph.add_to_window(pass(ids | points, visibility_bits)));
  CHECK_NOTHROW(graph.add_to_window(pass(points | visibility_bits, sums)));
  CHECK_NOTHROW(graph.add_after(pass(sums, channels)));
}

TEST_CASE("a second list may read what the first has left") {
  FrameGraph graph(ids | points);
  CHECK_NOTHROW(graph.add_before(pass(ids | points, sums)));
  CHECK_THROWS_AS(graph.add_after(pass(terms, channels)), std::logic_error);
}

TEST_CASE("passes are added in the order in which they run") {
  FrameGraph graph;
  graph.add_after(pass(no_resource, sums));
  CHECK_THROWS_AS(graph.add_before(pass(no_resource, ids)), std::logic_error);
  CHECK_THROWS_AS(graph.add_to_window(pass(no_resource, ids)), std::logic_error);
}
