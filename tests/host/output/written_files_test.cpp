#include "engine/model/error.h"
#include "host/output/files/output_set.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <utility>

using namespace pmdsim;

namespace {

std::string name_of(int i) { return "file" + std::to_string(i); }

std::vector<FileToWrite> numbered_files(int count) {
  std::vector<FileToWrite> files;
  for (int i = 0; i < count; ++i)
    files.push_back({name_of(i), [i](OutputFile &file) { file.write("content " + std::to_string(i)); }});
  return files;
}

} // namespace

TEST_CASE("files written together keep their order and their content") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  outputs.add("first", [](OutputFile &file) { file.write("1"); });
  outputs.add(write_files(temporary.path(), numbered_files(30)));
  for (const std::string &name : names_in(temporary.path()))
    CHECK(name.front() == '.');
  outputs.publish();
  const std::vector<std::string> paths = outputs.paths();
  REQUIRE(paths.size() == 31);
  for (int i = 0; i < 30; ++i) {
    CHECK(paths[static_cast<std::size_t>(i) + 1] == temporary.path() / name_of(i));
    CHECK(content_of(temporary.path() / name_of(i)) == "content " + std::to_string(i));
  }
  CHECK(names_in(temporary.path()).size() == 31);
}

TEST_CASE("one of several files that fails takes the others with it") {
  const pmdsim::test::TemporaryFolder temporary;
  std::vector<FileToWrite> files = numbered_files(30);
  files[17].write = [](OutputFile &) { throw Error(ExitCode::output, "disk full"); };
  CHECK_THROWS_WITH(write_files(temporary.path(), files), "disk full");
  CHECK(names_in(temporary.path()).empty());
}

TEST_CASE("files that are written and not published go") {
  const pmdsim::test::TemporaryFolder temporary;
  { const WrittenFiles files = write_files(temporary.path(), numbered_files(3)); }
  CHECK(names_in(temporary.path()).empty());
}
