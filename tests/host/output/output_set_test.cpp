#include "engine/model/error.h"
#include "host/output/files/output_set.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/file_size_limit.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace pmdsim;

namespace {

void write_hello(OutputFile &file) { file.write("hello"); }

// The message of the Error that `action` must throw, which must be one of output.
template <typename Action>
std::string output_error(Action action) {
  try {
    action();
  } catch (const Error &error) {
    CHECK(error.code() == ExitCode::output);
    return error.what();
  }
  FAIL("no error was thrown");
  return {};
}

} // namespace

TEST_CASE("published files have their names and nothing else is left") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path() / "a" / "b");
  outputs.add("one.txt", write_hello);
  outputs.add("two.txt", [](OutputFile &file) {
    file.write("0123456789");
    file.seek(4);
    file.write("XY");
    CHECK(file.tell() == 6);
  });
  for (const std::string &name : names_in(outputs.directory()))
    CHECK(name.front() == '.');
  outputs.publish();
  CHECK(names_in(outputs.directory()) == std::set<std::string>{"one.txt", "two.txt"});
  CHECK(content_of(outputs.directory() / "one.txt") == "hello");
  CHECK(content_of(outputs.directory() / "two.txt") == "0123XY6789");
  CHECK(outputs.paths() ==
        std::vector<std::string>{outputs.directory() / "one.txt", outputs.directory() / "two.txt"});
}

TEST_CASE("an existing file is replaced by publish and not before") {
  const pmdsim::test::TemporaryFolder temporary;
  std::ofstream(temporary.path() / "one.txt") << "old";
  OutputSet outputs(temporary.path());
  outputs.add("one.txt", write_hello);
  CHECK(content_of(temporary.path() / "one.txt") == "old");
  outputs.publish();
  CHECK(content_of(temporary.path() / "one.txt") == "hello");
}

TEST_CASE("what fails halfway leaves neither files nor directories") {
  const pmdsim::test::TemporaryFolder temporary;
  const auto fail_halfway = [&] {
    OutputSet outputs(temporary.path() / "a" / "b");
    outputs.add("one.txt", write_hello);
    outputs.add("two.txt", [](OutputFile &file) {
      file.write("half");
      throw std::runtime_error("halfway");
    });
  };
  CHECK_THROWS_WITH(fail_halfway(), "halfway");
  CHECK(names_in(temporary.path()).empty());
}

TEST_CASE("a directory that was there before a failure stays") {
  const pmdsim::test::TemporaryFolder temporary;
  { OutputSet unpublished(temporary.path()); }
  CHECK(std::filesystem::is_directory(temporary.path()));
}

TEST_CASE("a directory in the way of one file leaves the earlier results of the others") {
  const pmdsim::test::TemporaryFolder temporary;
  std::ofstream(temporary.path() / "one.txt") << "old";
  std::filesystem::create_directory(temporary.path() / "two.txt");
  OutputSet outputs(temporary.path());
  outputs.add("one.txt", write_hello);
  outputs.add("two.txt", write_hello);
  const std::string message = output_error([&] { outputs.publish(); });
  CHECK(message == (temporary.path() / "two.txt").string() + ": cannot be written: Is a directory");
  CHECK(content_of(temporary.path() / "one.txt") == "old");
}

TEST_CASE("what is obsolete goes, but not before it is known that the set can be published") {
  const pmdsim::test::TemporaryFolder temporary;
  std::ofstream(temporary.path() / "old.txt") << "old";
  std::filesystem::create_directory(temporary.path() / "one.txt");
  const auto publish = [&](const std::string &obsolete) {
    OutputSet outputs(temporary.path());
    outputs.add("one.txt", write_hello);
    outputs.give_names({obsolete});
  };
  output_error([&] { publish("old.txt"); });
  CHECK(content_of(temporary.path() / "old.txt") == "old");
  std::filesystem::remove(temporary.path() / "one.txt");
  publish("old.txt");
  CHECK(names_in(temporary.path()) == std::set<std::string>{"one.txt"});
  CHECK_NOTHROW(publish("never.txt"));
}

TEST_CASE("a directory in the place of what is obsolete is told before anything is replaced") {
  const pmdsim::test::TemporaryFolder temporary;
  std::filesystem::create_directory(temporary.path() / "old.txt");
  OutputSet outputs(temporary.path());
  outputs.add("one.txt", write_hello);
  CHECK(output_error([&] { outputs.give_names({"old.txt"}); }) ==
        (temporary.path() / "old.txt").string() + ": cannot be written: Is a directory");
  CHECK(names_in(temporary.path()).count("one.txt") == 0);
}

TEST_CASE("a link to a directory is replaced like any file") {
  const pmdsim::test::TemporaryFolder temporary;
  std::filesystem::create_directory(temporary.path() / "elsewhere");
  std::filesystem::create_directory_symlink("elsewhere", temporary.path() / "one.txt");
  OutputSet outputs(temporary.path());
  outputs.add("one.txt", write_hello);
  outputs.publish();
  CHECK(content_of(temporary.path() / "one.txt") == "hello");
  CHECK(std::filesystem::is_empty(temporary.path() / "elsewhere"));
}

TEST_CASE("a rename that fails takes back those before it") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  outputs.add("one.txt", write_hello);
  outputs.add("two.txt", write_hello);
  for (const std::string &name : names_in(temporary.path()))
    if (name.starts_with(".two.txt"))
      std::filesystem::remove(temporary.path() / name);
  const std::string message = output_error([&] { outputs.publish(); });
  CHECK(message ==
        (temporary.path() / "two.txt").string() + ": cannot be written: No such file or directory");
  CHECK(names_in(temporary.path()).count("one.txt") == 0);
}

TEST_CASE("an output directory that is a file is refused by name and reason") {
  const pmdsim::test::TemporaryFolder temporary;
  const auto file = temporary.path() / "file";
  std::ofstream(file) << "text";
  CHECK(output_error([&] { OutputSet outputs(file); }) ==
        file.string() + ": output directory cannot be written: Not a directory");
  CHECK(output_error([&] { OutputSet outputs(file / "below"); }) ==
        (file / "below").string() + ": output directory cannot be written: Not a directory");
}

TEST_CASE("a full disk is an error even where a library swallowed it") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  const FileSizeLimit limit(1000);
  const auto write_too_much = [](OutputFile &file) {
    try {
      file.write(std::string(100000, 'x'));
    } catch (const Error &) {
    }
  };
  CHECK(output_error([&] { outputs.add("full.exr", write_too_much); }) ==
        (temporary.path() / "full.exr").string() + ": cannot be written: File too large");
  CHECK(names_in(temporary.path()).empty());
}

TEST_CASE("a disk that is full within a large array is an error") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  const FileSizeLimit limit(1000000);
  CHECK(output_error([&] {
          outputs.add("large.npy", [](OutputFile &file) { file.write(std::string(2000000, 'x')); });
        }) == (temporary.path() / "large.npy").string() + ": cannot be written: File too large");
  CHECK(names_in(temporary.path()).empty());
}

TEST_CASE("a disk without room for a file says so before it is written") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  const FileSizeLimit limit(1000);
  const auto reserve_too_much = [](OutputFile &file) {
    file.reserve(100000);
    FAIL("there is no room");
  };
  CHECK(output_error([&] { outputs.add("large.npy", reserve_too_much); }) ==
        (temporary.path() / "large.npy").string() + ": cannot be written: File too large");
  outputs.add("small.npy", [](OutputFile &file) {
    file.reserve(5);
    file.write("hello");
  });
  outputs.publish();
  CHECK(content_of(temporary.path() / "small.npy") == "hello");
}

TEST_CASE("a disk that is full only at the last flush is an error too") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  const FileSizeLimit limit(3);
  CHECK(output_error([&] { outputs.add("full.txt", write_hello); }).find("File too large") !=
        std::string::npos);
}

TEST_CASE("a name with a slash is refused") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputSet outputs(temporary.path());
  CHECK(output_error([&] { outputs.add("../out.txt", write_hello); }).find("../out.txt") == 0);
}
