// Lets a shader write the word with the index that is its argument, of a buffer of sixteen, under the
// validation that PMDSIM_VALIDATE asks for. A program of its own, as it ends where that is found.

#include "engine/vulkan/commands.h"
#include "engine/vulkan/compute_pipeline.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>

namespace pmdsim::shader::spirv {
extern const std::span<const std::uint32_t> write_beyond;
}

using namespace pmdsim;

namespace {

void write_word(const vulkan::Device &device, std::uint32_t index) {
  struct Constants {
    glm::uvec2 words;
    std::uint32_t index;
  };
  const vulkan::Buffer words(device, 16 * sizeof(std::uint32_t), {}, vulkan::Memory::device);
  const vulkan::ShaderModule module{"write_beyond", vulkan::SampleReal::any, shader::spirv::write_beyond};
  const vulkan::ComputePipeline pipeline(device, module, sizeof(Constants));
  vulkan::Commands commands(device);
  pipeline.dispatch(commands.begin(), Constants{words.words(), index}, 1, 1);
  commands.submit_and_wait();
}

} // namespace

int main(int, char **argv) {
  try {
    const vulkan::Instance instance(validation_of(std::getenv("PMDSIM_VALIDATE")));
    for (auto &physical : instance.devices())
      if (vulkan::what_is_lacking(physical).empty())
        write_word(vulkan::Device(instance, physical), static_cast<std::uint32_t>(std::stoul(argv[1])));
    return 0;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
