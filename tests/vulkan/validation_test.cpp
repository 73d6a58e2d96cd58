// Under GPU-assisted validation a shader that writes beyond its buffer is found, so that a suite without a
// message says something.

#include "tests/support/temporary_folder.h"

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

Said write_word(const std::string &index) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "said").string();
  const int status = std::system(("'" WRITE_BEYOND "' " + index + " 2> '" + file + "'").c_str());
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return {status, text.str()};
}

} // namespace

TEST_CASE("a shader that writes beyond its buffer is found under GPU-assisted validation") {
  const Said inside = write_word("15");
  INFO(inside.text);
  CHECK(inside.status == 0);
  CHECK(inside.text.empty());
  const Said beyond = write_word("100000");
  INFO(beyond.text);
  CHECK(beyond.status != 0);
  CHECK(beyond.text.find("out of bounds") != std::string::npos);
}
