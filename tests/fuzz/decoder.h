#pragma once
// Bytes of a fuzzer as the choices that a target makes. Beyond their end all choices are the first one.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace pmdsim::fuzz {

class Decoder {
public:
  Decoder(const std::uint8_t *data, std::size_t size) : data_(data), left_(size) {}

  bool is_at_end() const { return left_ == 0; }

  std::uint8_t byte() {
    if (left_ == 0)
      return 0;
    --left_;
    return *data_++;
  }
  bool flag() { return (byte() & 1u) != 0; }
  // 0 to `count` - 1, of 256 at most.
  std::size_t below(std::size_t count) { return byte() % count; }
  template <class Value, std::size_t n>
  const Value &one_of(const std::array<Value, n> &values) {
    return values[below(n)];
  }
  std::uint64_t bits(std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value |= std::uint64_t{byte()} << (8 * i);
    return value;
  }
  // Both ends are reached.
  double uniform(double lowest, double highest) {
    return lowest + (highest - lowest) * static_cast<double>(bits(2)) / 65535.0;
  }
  double log_uniform(double lowest, double highest) {
    return std::exp(uniform(std::log(lowest), std::log(highest)));
  }
  // Up to as many bytes as the next one says, or, where that is 255, the next two.
  std::string text() {
    const std::size_t most = byte();
    std::string text(most == 255 ? bits(2) : most, '\0');
    std::size_t length = 0;
    for (; length < text.size() && !is_at_end(); ++length)
      text[length] = static_cast<char>(byte());
    text.resize(length);
    return text;
  }

private:
  const std::uint8_t *data_;
  std::size_t left_;
};

} // namespace pmdsim::fuzz
