// A pipeline gets all constants that its shader declares and no others.

#include "engine/vulkan/compute_pipeline.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/interface.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::vulkan;
using Catch::Matchers::Contains;

namespace {

const ShaderModule &module_of(std::string_view name) {
  for (const ShaderModule &module : shader_modules())
    if (module.name == name)
      return module;
  throw std::logic_error("no such shader");
}

Specialization all_of(const ShaderModule &module) {
  Specialization constants;
  for (const auto &[number, name] : declared_constants(module.spirv))
    constants.set(number, 1);
  return constants;
}

Specialization all_but(const ShaderModule &module, std::uint32_t forgotten) {
  const Specialization all = all_of(module);
  Specialization constants;
  for (const auto &[constant, value] : all.values())
    if (constant != forgotten)
      constants.set(constant, value);
  return constants;
}

} // namespace

TEST_CASE("a pipeline refuses a constant that was forgotten, by its shader's name and its own") {
  const Instance instance(Validation::none);
  for (auto &physical : instance.devices()) {
    if (!what_is_lacking(physical).empty())
      continue;
    const Device device(instance, physical);
    const ShaderModule &module = shader_module(device, SamplePrecision::automatic, "settle_edges");
    const auto make = [&](const Specialization &constants) {
      return ComputePipeline(device, module, sizeof(shader::SettleEdgesConstants), constants);
    };
    CHECK_NOTHROW(make(all_of(module)));
    CHECK_THROWS_AS(make({}), std::logic_error);
    CHECK_THROWS_WITH(make(all_but(module, shader::constant_tiled)),
                      Contains("settle_edges") && Contains("tiled"));
    CHECK_THROWS_WITH(make(all_but(module, shader::constant_general_chip)),
                      Contains("settle_edges") && Contains("general_chip"));
  }
}

TEST_CASE("no shader takes the default of any of its constants") {
  for (const ShaderModule &module : shader_modules())
    for (const auto &[number, name] : declared_constants(module.spirv)) {
      INFO(module.name << ": " << name);
      CHECK_THROWS_WITH(declared_part(module, all_but(module, number)),
                        Contains(std::string(module.name)) && Contains(name));
    }
}

TEST_CASE("a vertex shader's constant may be a float") {
  const ShaderModule &module = module_of("id_raster_vert");
  CHECK_THROWS_WITH(declared_part(module, {}), Contains("half_viewport"));
}

TEST_CASE("constants that a module does not declare stay outside") {
  const ShaderModule &module = module_of("settle_edges");
  Specialization constants = all_of(module);
  constants.set(shader::constant_taps, 4);
  CHECK(declared_part(module, constants) == all_of(module));
}

TEST_CASE("a constant has one value") {
  Specialization constants{{shader::constant_taps, 4}};
  CHECK_NOTHROW(constants.merge({{shader::constant_taps, 4}, {shader::constant_planes, 2}}));
  CHECK(constants == Specialization{{shader::constant_taps, 4}, {shader::constant_planes, 2}});
  CHECK_THROWS_AS(constants.merge({{shader::constant_taps, 5}}), std::logic_error);
}
