// Links that somebody else has put where outputs come: they are replaced, and what they lead to stays.

#include "tests/program/program.h"
#include "tests/whole/command_line/run_fixture.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <sys/stat.h>

using namespace pmdsim::test;
namespace fs = std::filesystem;

namespace {

class Victim {
public:
  explicit Victim(const Workspace &work) : file_(work.write("victim", "its bytes")) {}

  // Puts links to it, or to what is not there, in the place of all files of a folder; returns their names.
  std::vector<std::string> take_places(const Workspace &work, const std::string &folder) const {
    const std::vector<std::string> names = work.files(folder);
    bool to_nothing = false;
    for (const std::string &name : names) {
      const fs::path path = fs::path(work / folder) / name;
      fs::remove(path);
      fs::create_symlink(to_nothing ? absent() : file_, path);
      to_nothing = !to_nothing;
    }
    return names;
  }
  void check_untouched() const {
    CHECK(bytes_in(file_.string()) == "its bytes");
    CHECK_FALSE(fs::exists(absent()));
  }

private:
  fs::path absent() const { return file_.parent_path() / "absent"; }

  fs::path file_;
};

// Runs a command twice, the second time over links in the place of all that the first has written.
void check_replaces_links(const Workspace &work, const std::vector<std::string> &arguments,
                          const std::string &folder) {
  const auto run_well = [&] {
    const Run ended = run_pmdsim(arguments);
    INFO(ended.errors);
    REQUIRE(ended.exit_code == 0);
  };
  run_well();
  const Victim victim(work);
  const std::vector<std::string> names = victim.take_places(work, folder);
  REQUIRE_FALSE(names.empty());
  run_well();
  victim.check_untouched();
  for (const std::string &name : names) {
    INFO(name);
    CHECK(fs::is_regular_file(fs::symlink_status(fs::path(work / folder) / name)));
  }
}

} // namespace

TEST_CASE("commands replace links in their output folders") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  const std::string formats = "exr,npz,h5,npy,ply,png,csv";
  SECTION("render, with a page and pictures of all frames") {
    check_replaces_links(work,
                         {"render", setup, "--set", "frames/count=2", "--set", "frames/rate_hz=10",
                          "--format", formats, "--report", "-o", work / "out"},
                         "out");
  }
  SECTION("deform, with profiles") {
    check_replaces_links(work, {"deform", setup, "--format", formats, "-o", work / "out"}, "out");
  }
  SECTION("diodes") {
    check_replaces_links(work, {"diodes", setup, "--boards", "100", "-o", work / "out"}, "out");
  }
  SECTION("correct") {
    REQUIRE(run_pmdsim({"render", setup, "-o", work / "frames"}).exit_code == 0);
    check_replaces_links(work, {"correct", setup, work / "frames/pmd_0000.exr", "-o", work / "out"}, "out");
  }
  SECTION("merge, and a report elsewhere") {
    REQUIRE(run_pmdsim({"render", setup, "-o", work / "frames"}).exit_code == 0);
    check_replaces_links(work, {"merge", work / "frames", "-o", work / "out"}, "out");
    fs::create_directory(work / "page");
    check_replaces_links(work, {"report", work / "frames", "-o", work / "page/page.html"}, "page");
  }
  SECTION("new and schema") {
    check_replaces_links(work, {"new", "room", work / "out", "--force"}, "out");
    fs::create_directory(work / "schema");
    check_replaces_links(work, {"schema", "-o", work / "schema/setup.schema.json"}, "schema");
  }
  SECTION("variants, with their table") {
    const std::string variants = work.write("variants.jsonl", "{}\n{\"sensors/0/samples\": 2}\n");
    check_replaces_links(work, {"render", setup, "--variants", variants, "-o", work / "out"}, "out");
  }
}

TEST_CASE("no pipe is replaced by a file") {
  const Workspace work;
  REQUIRE(::mkfifo((work / "fifo").c_str(), 0600) == 0);
  const Run refused = run_pmdsim({"schema", "-o", work / "fifo"});
  CHECK(refused.exit_code == 7);
  CHECK(refused.errors.find("fifo: cannot be written: is no file") != std::string::npos);
  CHECK(fs::is_fifo(work / "fifo"));
}

TEST_CASE("an output folder may be a link of the user's, a folder of variants inside of it may not") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  const std::string variants = work.write("variants.jsonl", "{}\n{\"sensors/0/samples\": 2}\n");
  fs::create_directory(work / "disk");
  fs::create_directory_symlink(work / "disk", work / "out");
  const std::vector<std::string> arguments{"render", setup, "--variants", variants, "-o", work / "out"};
  REQUIRE(run_pmdsim(arguments).exit_code == 0);
  CHECK(fs::exists(work / "disk/0001/manifest.json"));
  fs::create_directory(work / "private");
  fs::remove_all(work / "disk/0001");
  fs::create_directory_symlink(work / "private", work / "disk/0001");
  const Run refused = run_pmdsim(arguments);
  CHECK(refused.exit_code == 7);
  CHECK(refused.errors.find("out/0001: is a symbolic link, expected a folder or nothing") !=
        std::string::npos);
  CHECK(fs::is_empty(work / "private"));
}

TEST_CASE("a scene reads outside of its folder only where the user allows it") {
  const Workspace work;
  fs::create_directory(work / "inside");
  const std::string gltf = wall_gltf();
  const auto from = gltf.find("data:"), to = gltf.find('"', from);
  work.write("inside/scene.gltf", std::string(gltf).replace(from, to - from, "../wall.bin"));
  const std::string setup = work.write("setup.json", small_setup("inside/scene.gltf"));
  const std::vector<float> corners{-0.2f, -0.2f, -2.0f, 0.2f,  -0.2f, -2.0f,
                                   0.2f,  0.2f,  -2.0f, -0.2f, 0.2f,  -2.0f};
  work.write("wall.bin", std::string(reinterpret_cast<const char *>(corners.data()), 48) +
                             std::string("\0\1\2\0\2\3", 6));
  const Run refused = run_pmdsim({"check", setup});
  CHECK(refused.exit_code == 3);
  CHECK(refused.errors.find("inside/scene.gltf") != std::string::npos);
  CHECK(refused.errors.find("lies outside the scene's folder") != std::string::npos);
  const Run allowed = run_pmdsim({"check", setup, "--allow-outside"});
  INFO(allowed.errors);
  CHECK(allowed.exit_code == 0);
}
