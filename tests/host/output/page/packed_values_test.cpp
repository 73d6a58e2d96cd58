// Values survive their way into a page and out of it, each bit of them.

#include "host/output/page/packed_values.h"
#include "tests/host/output/page/page_reading.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <span>

using namespace pmdsim;

namespace {

template <class Value>
void check_survive(const std::vector<Value> &values) {
  const std::string bytes =
      test::unpacked(packed(std::as_bytes(std::span(values)), sizeof(Value)), sizeof(Value));
  CHECK(bytes == std::string(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(Value)));
}

} // namespace

TEST_CASE("packed values come out as they went in, infinities and every kind of NaN among them") {
  std::mt19937 random(20261127);
  std::vector<std::uint32_t> bits(4099);
  for (std::uint32_t &each : bits)
    each = static_cast<std::uint32_t>(random());
  check_survive(bits);
  std::vector<float> floats{std::numeric_limits<float>::infinity(), -0.0f, std::nanf("")};
  for (const std::uint32_t each : bits)
    floats.push_back(std::bit_cast<float>(each));
  check_survive(floats);
  check_survive(std::vector<double>{0.1, -1e300, std::nan("")});
}

TEST_CASE("of every length, whatever is left of the last three bytes") {
  for (std::uint32_t count = 1; count <= 9; ++count)
    check_survive(std::vector<std::uint32_t>(count, 0xdeadbeefu * count));
}

TEST_CASE("smooth values take less room than they have bytes, though base64 has four for three") {
  std::vector<float> values;
  for (int i = 0; i < 100'000; ++i)
    values.push_back(2.0f + 1e-6f * static_cast<float>(i));
  CHECK(packed(std::as_bytes(std::span(values)), sizeof(float)).size() < values.size() * sizeof(float) / 2);
}
