#include "engine/vulkan/shader_module.h"

#include "engine/vulkan/device.h"

#include <algorithm>

namespace pmdsim::vulkan {
namespace {

// Khronos' SPIR-V specification, sections 2.3, 3.20 and 3.49.
constexpr std::size_t header_words = 5;
constexpr std::uint32_t op_name = 5, op_decorate = 71, spec_id = 1;

std::string label(const ShaderModule &module) {
  const char *form = module.real == SampleReal::any    ? ""
                     : module.real == SampleReal::fp64 ? " (fp64)"
                                                       : " (float pairs)";
  return std::string(module.name) + form;
}

} // namespace

bool uses_fp64(const Device &device, SamplePrecision wanted) {
  return device.has_fp64() && wanted == SamplePrecision::automatic;
}

const ShaderModule &shader_module(const Device &device, SamplePrecision wanted, std::string_view name) {
  const SampleReal real = uses_fp64(device, wanted) ? SampleReal::fp64 : SampleReal::float_pairs;
  const auto modules = shader_modules();
  const auto found = std::ranges::find_if(modules, [&](const ShaderModule &module) {
    return module.name == name && (module.real == SampleReal::any || module.real == real);
  });
  if (found == modules.end())
    throw std::logic_error("there is no shader " + std::string(name));
  return *found;
}

std::map<std::uint32_t, std::string> declared_constants(std::span<const std::uint32_t> spirv) {
  std::map<std::uint32_t, std::string> names;     // of results
  std::map<std::uint32_t, std::string> constants; // a workgroup's size may repeat one without a name
  for (std::size_t at = header_words; at < spirv.size(); at += spirv[at] >> 16) {
    const std::uint32_t operation = spirv[at] & 0xffffu;
    if (operation == op_name) // names come before decorations
      names[spirv[at + 1]] = reinterpret_cast<const char *>(&spirv[at + 2]);
    if (operation == op_decorate && spirv[at + 2] == spec_id)
      if (std::string &name = constants[spirv[at + 3]]; name.empty())
        name = names[spirv[at + 1]];
  }
  return constants;
}

Specialization declared_part(const ShaderModule &module, const Specialization &constants) {
  Specialization part;
  for (const auto &[number, name] : declared_constants(module.spirv)) {
    const auto value = constants.values().find(number);
    if (value == constants.values().end())
      throw std::logic_error("the shader " + label(module) + " declares the constant " + name +
                             ", which has no value");
    part.set(number, value->second);
  }
  return part;
}

} // namespace pmdsim::vulkan
