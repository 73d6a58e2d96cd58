// Which files were read, and what they held.

#include "host/input/file/content_hash.h"
#include "host/input/file/files_read.h"
#include "host/input/file/input_file.h"
#include "host/input/setup/setup.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

std::string read(const std::filesystem::path &file) { return read_regular_file(file, 1000, Place{file}); }

} // namespace

TEST_CASE("a hash is XXH3's of 128 bits") {
  CHECK(content_hash("") == "99aa06d3014798d86001c324468d497f"); // as xxh128sum prints it
  CHECK(content_hash("a") != content_hash("b"));
}

TEST_CASE("what is read is noted once, by its path in the folder, while somebody listens") {
  const test::TemporaryFolder folder, other;
  const auto file = folder.write("a.txt", "hello"), elsewhere = other.write("b.txt", "world");
  read(file);
  const FilesRead files(folder.path());
  CHECK(files.list().empty());
  read(file);
  read(file);
  read_front_of_regular_file(elsewhere, 2, Place{elsewhere});
  CHECK(files.list() == std::vector<FileRead>{{"a.txt", 5, content_hash("hello")},
                                              {elsewhere.string(), 2, content_hash("wo")}});
  {
    const FilesRead inner({});
    read(file);
    CHECK(inner.list().front().path == file.string());
  }
  folder.write("a.txt", "hallo");
  read(file);
  CHECK(files.list().size() == 3);
}

TEST_CASE("a setup knows the files that it names, and those that these name, whatever its folder") {
  const auto paths = [](const std::string &scene) {
    std::vector<std::string> all;
    for (const FileRead &file : load_setup(std::string(PMDSIM_SCENES) + "/" + scene).inputs)
      all.push_back(file.path);
    return all;
  };
  CHECK(paths("paper_ring.json") == std::vector<std::string>{"wall_2m.gltf"});
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(PMDSIM_SCENES);
  const auto relative = load_setup("paper_ring.json").inputs;
  std::filesystem::current_path(before);
  CHECK(relative == load_setup(PMDSIM_SCENES "/paper_ring.json").inputs);
}
