#pragma once
// Values of specialization constants, by their numbers.

#include <cstdint>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace pmdsim::vulkan {

class Specialization {
public:
  Specialization() = default;
  Specialization(std::initializer_list<std::pair<const std::uint32_t, std::uint32_t>> values)
      : values_(values) {}

  // Of a float the bits.
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

} // namespace pmdsim::vulkan
