#pragma once
// All compiled shaders, each with what it is called, which arithmetic it is compiled for and which
// specialization constants it declares. The table is made by shaders/CMakeLists.txt.

#include "engine/model/simulator_options.h"
#include "engine/vulkan/specialization.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim::vulkan {

class Device;

// What a shader does in extended precision: nothing, or with fp64, or with pairs of floats.
enum class SampleReal { any, fp64, float_pairs };

struct ShaderModule {
  std::string_view name;
  SampleReal real;
  std::span<const std::uint32_t> spirv; // lives as long as the program
};

std::span<const ShaderModule> shader_modules();

bool uses_fp64(const Device &device, SamplePrecision wanted);
// The form of a shader that the device runs. Throws std::logic_error where there is none of that name.
const ShaderModule &shader_module(const Device &device, SamplePrecision wanted, std::string_view name);

// The specialization constants that SPIR-V declares, in the order of their numbers.
struct DeclaredConstant {
  std::uint32_t number;
  std::string name;

  bool operator==(const DeclaredConstant &) const = default;
};
std::vector<DeclaredConstant> declared_constants(std::span<const std::uint32_t> spirv);

// Of `constants` those that the module declares. Throws std::logic_error, which names both, where one of them
// was not given a value.
Specialization declared_part(const ShaderModule &module, const Specialization &constants);

} // namespace pmdsim::vulkan
