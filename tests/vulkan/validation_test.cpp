// A shader that writes beyond its buffer is found, so that a suite that ends well says something: by
// GPU-assisted validation, and where tests run on lavapipe, whose memory they guard.

#include "engine/vulkan/instance.h"
#include "tests/support/temporary_folder.h"
#include "tests/vulkan/lavapipe.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace pmdsim::test;

namespace {

struct Said {
  int status;
  std::string text;
};

Said write_word(const std::string &environment, const std::string &index) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "said").string();
  const std::string command = environment + " '" WRITE_BEYOND "' " + index;
  const int status = std::system((command + " 2> '" + file + "'").c_str());
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return {status, text.str()};
}

bool there_is_lavapipe() {
  const pmdsim::vulkan::Instance instance(pmdsim::Validation::none);
  return std::ranges::any_of(instance.devices(), is_lavapipe);
}

} // namespace

TEST_CASE("a shader that writes beyond its buffer is found under GPU-assisted validation") {
  const Said inside = write_word("PMDSIM_VALIDATE=gpu", "15");
  INFO(inside.text);
  CHECK(inside.status == 0);
  CHECK(inside.text.empty());
  const Said beyond = write_word("PMDSIM_VALIDATE=gpu", "100000");
  INFO(beyond.text);
  CHECK(beyond.status != 0);
  CHECK(beyond.text.find("out of bounds") != std::string::npos);
}

TEST_CASE("a shader that writes the first word beyond its buffer ends the process under guarded memory",
          "[no_sanitizer]") {
  if (!there_is_lavapipe()) {
    WARN("no lavapipe: nothing tested");
    return;
  }
  const std::string guarded = "PMDSIM_VALIDATE=0 LD_PRELOAD='" GUARDED_MEMORY "'";
  CHECK(write_word(guarded, "15").status == 0);
  const Said beyond = write_word(guarded, "16");
  CHECK(beyond.status != 0);
  CHECK(beyond.text.find("Segmentation fault") != std::string::npos);
}
