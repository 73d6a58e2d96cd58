#include "engine/model/error.h"
#include "host/bench/timing.h"
#include "tests/host/output/directory_content.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <cstdlib>

using namespace pmdsim;

namespace {

// Where temporary files go while it lives.
class TemporaryFilesIn {
public:
  explicit TemporaryFilesIn(const std::string &directory) { ::setenv("TMPDIR", directory.c_str(), 1); }
  ~TemporaryFilesIn() { ::unsetenv("TMPDIR"); }
  TemporaryFilesIn(const TemporaryFilesIn &) = delete;
  TemporaryFilesIn &operator=(const TemporaryFilesIn &) = delete;
};

struct MeasuredWall {
  test::Workspace work;
  Setup setup;
  BenchRequest request;

  MeasuredWall() {
    work.write("wall.gltf", test::wall_gltf());
    setup = load_setup(work.write("setup.json", test::small_setup()));
    std::filesystem::create_directory(work / "temporary");
  }
};

} // namespace

TEST_CASE("a sequence's rate is known without writing, as NPY and as EXR, and no file of it is left") {
  const MeasuredWall wall;
  const TemporaryFilesIn there(wall.work / "temporary");
  const SequenceRate rate = measure_sequence_rate(wall.setup, wall.request, 5);
  CHECK(rate.frames == 5);
  CHECK(rate.measured_per_s > 0.0);
  CHECK(rate.npy_per_s > 0.0);
  CHECK(rate.exr_per_s > 0.0);
  CHECK(names_in(wall.work / "temporary").empty());
}

TEST_CASE("a sequence that fails in the middle leaves no file either") {
  MeasuredWall wall;
  wall.setup.start.sensors[0].name = std::string(300, 'x'); // too long for a file's name
  const TemporaryFilesIn there(wall.work / "temporary");
  CHECK_THROWS_WITH(measure_sequence_rate(wall.setup, wall.request, 5),
                    Catch::Contains("File name too long"));
  CHECK(names_in(wall.work / "temporary").empty());
}

TEST_CASE("a directory for temporary files that is none is told") {
  const MeasuredWall wall;
  const TemporaryFilesIn nowhere(wall.work / "nowhere");
  CHECK_THROWS_WITH(measure_sequence_rate(wall.setup, wall.request, 2),
                    "TMPDIR: expected a directory for temporary files: No such file or directory");
}
