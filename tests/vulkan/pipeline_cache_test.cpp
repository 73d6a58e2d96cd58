// A pipeline that was compiled once is not compiled again while there is room.

#include "engine/vulkan/device.h"

#include <catch2/catch.hpp>

using namespace pmdsim::vulkan;

namespace {

constexpr std::uint32_t one_shader = 1, other_shader = 1;

// Compiles nothing, but counts.
struct Compiler {
  PipelineCache cache;
  int compiled = 0;

  std::shared_ptr<const Pipeline> get(const std::uint32_t *spirv, const Specialization &constants) {
    return cache.get({spirv, constants}, [&] {
      ++compiled;
      return Pipeline{};
    });
  }
};

} // namespace

TEST_CASE("a pipeline is known by its shader and its constants") {
  Compiler compiler;
  const auto first = compiler.get(&one_shader, {{0, 1}, {1, 2}});
  CHECK(compiler.get(&one_shader, {{0, 1}, {1, 2}}) == first);
  CHECK(compiler.compiled == 1);
  CHECK(compiler.get(&one_shader, {{0, 1}, {1, 3}}) != first);
  CHECK(compiler.get(&one_shader, {{0, 1}}) != first);
  CHECK(compiler.get(&other_shader, {{0, 1}, {1, 2}}) != first);
  CHECK(compiler.compiled == 4);
}

TEST_CASE("a full cache forgets what nobody uses") {
  Compiler compiler;
  const auto used = compiler.get(&one_shader, {{0, 0}});
  for (std::uint32_t i = 1; i < 1000; ++i)
    compiler.get(&one_shader, {{0, i}});
  CHECK(compiler.get(&one_shader, {{0, 0}}) == used);
  CHECK(compiler.compiled == 1000);
  compiler.get(&one_shader, {{0, 1}});
  CHECK(compiler.compiled == 1001);
}
