// What is in a folder, without its own name and its parent's.

#include "host/input/words/folder_names.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;
namespace fs = std::filesystem;

TEST_CASE("A folder's names are its files' and folders'") {
  const test::TemporaryFolder folder;
  std::error_code error;
  CHECK(names_in(folder.path(), error).empty());
  CHECK(!error);

  fs::create_directory(folder.path() / "parts");
  folder.write("wall.gltf", "{}");
  folder.write("..hidden", "");
  std::vector<std::string> names = names_in(folder.path(), error);
  std::ranges::sort(names);
  CHECK(names == std::vector<std::string>{"..hidden", "parts", "wall.gltf"});
  CHECK(names_in(folder.path(), error, 2).size() == 2);
}

TEST_CASE("What cannot be listed has no names, and a reason") {
  const test::TemporaryFolder folder;
  folder.write("file", "");
  std::error_code error;
  CHECK(names_in(folder.path() / "absent", error).empty());
  CHECK(error == std::errc::no_such_file_or_directory);
  CHECK(names_in(folder.path() / "file", error).empty());
  CHECK(error == std::errc::not_a_directory);
}
