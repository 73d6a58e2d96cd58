// Philox4x32-10 beside its known answers, in GLSL, in C++ and in the judge: those of the kat_vectors of
// Random123 1.09 (D. E. Shaw Research).

#include "engine/reference/electronics/philox.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/compute_pipeline.h"
#include "shaders/shared/philox.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <span>
#include <vector>

namespace pmdsim::shader::spirv {
extern const std::span<const std::uint32_t> philox_test;
}

using namespace pmdsim;

namespace {

struct KnownAnswer {
  std::array<std::uint32_t, 4> counter;
  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> words;

  bool operator==(const KnownAnswer &) const = default;
};

const std::vector<KnownAnswer> known_answers{
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
     {0xffffffff, 0xffffffff},
     {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
};

std::array<std::uint32_t, 4> words_of(const shader::uvec4 &v) { return {v.x, v.y, v.z, v.w}; }

shader::uvec4 counter_of(const KnownAnswer &answer) {
  const auto &[x, y, z, w] = answer.counter;
  return {x, y, z, w};
}

// All counters at once, on a device.
std::vector<shader::uvec4> on_device(const vulkan::Device &device) {
  std::vector<shader::uvec4> counters;
  std::vector<shader::uvec2> keys;
  for (const KnownAnswer &answer : known_answers) {
    counters.push_back(counter_of(answer));
    keys.emplace_back(answer.key[0], answer.key[1]);
  }
  struct Constants {
    shader::uvec2 counters, keys;
  };
  const auto count = static_cast<std::uint32_t>(counters.size());
  const vulkan::Buffer in_out =
      vulkan::upload(device, std::as_bytes(std::span(counters)), vk::BufferUsageFlagBits::eTransferSrc);
  const vulkan::Buffer of_keys = vulkan::upload(device, keys);
  vulkan::Buffer read(device, in_out.bytes(), vk::BufferUsageFlagBits::eTransferDst, vulkan::Memory::read);
  const vulkan::ShaderModule module{"philox", vulkan::SampleReal::any, shader::spirv::philox_test};
  const vulkan::ComputePipeline pipeline(device, module, sizeof(Constants));
  vulkan::Commands commands(device);
  const auto &buffer = commands.begin();
  pipeline.dispatch(buffer, Constants{in_out.words(), of_keys.words()}, count, 1);
  vulkan::memory_barrier(buffer, vk::PipelineStageFlagBits2::eComputeShader,
                         vk::AccessFlagBits2::eShaderStorageWrite, vk::PipelineStageFlagBits2::eTransfer,
                         vk::AccessFlagBits2::eTransferRead);
  buffer.copyBuffer(in_out.get(), read.get(), vk::BufferCopy(0, 0, in_out.bytes()));
  commands.submit_and_wait();
  std::memcpy(counters.data(), read.mapped().data(), counters.size() * sizeof(counters[0]));
  return counters;
}

} // namespace

TEST_CASE("Philox gives its known answers in C++ and in the judge") {
  for (const KnownAnswer &answer : known_answers) {
    CHECK(words_of(shader::philox(counter_of(answer), {answer.key[0], answer.key[1]})) == answer.words);
    CHECK(reference::philox4x32(answer.counter, answer.key) == answer.words);
  }
}

TEST_CASE("Philox gives its known answers in GLSL on every device") {
  const vulkan::Instance instance(Validation::none);
  int devices = 0;
  for (auto &physical : instance.devices()) {
    if (!vulkan::what_is_lacking(physical).empty())
      continue;
    ++devices;
    const vulkan::Device device(instance, physical);
    const std::vector<shader::uvec4> found = on_device(device);
    for (std::size_t i = 0; i < known_answers.size(); ++i)
      CHECK(words_of(found[i]) == known_answers[i].words);
  }
  CHECK(devices > 0);
}
