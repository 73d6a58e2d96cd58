#pragma once
// All compiled shaders, each with its name, the arithmetic that it is compiled for and the specialization
// constants that it declares, and the values of these. The table is made by shaders/CMakeLists.txt.

#include "engine/model/simulator_options.h"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace pmdsim::vulkan {

class Device;

// The arithmetic of a shader's extended precision: none is needed, fp64, or pairs of floats.
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

// Values of specialization constants, by their numbers.
class Specialization {
public:
  Specialization() = default;
  Specialization(std::initializer_list<std::pair<const std::uint32_t, std::uint32_t>> values)
      : values_(values) {}

  // A float is given by its bits.
  Specialization &set(std::uint32_t constant, std::uint32_t value) {
    values_[constant] = value;
    return *this;
  }
  // Takes the other's values, too. Throws std::logic_error where both have one and these differ.
  Specialization &merge(const Specialization &other) {
    for (const auto &[constant, value] : other.values_)
      if (values_.emplace(constant, value).first->second != value)
        throw std::logic_error("specialization constant " + std::to_string(constant) + " has two values");
    return *this;
  }

  const std::map<std::uint32_t, std::uint32_t> &values() const { return values_; }
  auto operator<=>(const Specialization &) const = default;

private:
  std::map<std::uint32_t, std::uint32_t> values_;
};

// The names of the specialization constants that SPIR-V declares, by their numbers.
std::map<std::uint32_t, std::string> declared_constants(std::span<const std::uint32_t> spirv);

// Those of `constants` that the module declares. Throws std::logic_error, which names module and constant,
// where one was not given a value.
Specialization declared_part(const ShaderModule &module, const Specialization &constants);

} // namespace pmdsim::vulkan
