// Which files a frame with light that bounces leaves.

#include "host/capture/capture.h"
#include "host/output/files/output_set.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

using namespace pmdsim;

TEST_CASE("the picture of object_id has the objects' names") {
  const auto taken = std::make_shared<TakenFrame>();
  taken->sensor.name = "pmd";
  taken->sensor.resolution = {2, 1};
  taken->measurement.resolution = {2, 1};
  taken->measurement.object_id = {0, 1};
  const auto picture = [&](const std::vector<std::string> &names) {
    MeasuredPart part = rendered_frame(taken, {0, 0.0, 0, "", {}}, {Format::png}, names);
    const test::TemporaryFolder folder;
    OutputSet files(folder.path());
    for (const FileToWrite &file : part.files(part.record))
      files.add(file.name, file.write);
    files.publish();
    REQUIRE(files.paths().size() == 1);
    std::ifstream in(files.paths()[0], std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const bool is_same = picture({}) == picture({}), has_names = picture({"wall", "ball"}) != picture({});
  CHECK(is_same);
  CHECK(has_names);
}

TEST_CASE("pictures show multipath and its share, and no channel without bounces") {
  const auto taken = std::make_shared<TakenFrame>();
  taken->sensor.name = "pmd";
  taken->sensor.resolution = {2, 1};
  taken->sensor.modulation_hz = {20e6};
  taken->measurement.resolution = {2, 1};
  taken->measurement.bounces = BouncesReport{10, 100, 3, 1e-3};
  Return &returned = taken->measurement.returns.emplace_back();
  returned.distance_m = returned.direct_distance_m = {1.0f, 2.0f};
  returned.direct_amplitude = returned.direct_phase_rad = {1.0f, 1.0f};
  returned.multipath_m = {2e-3f, -1e-3f};
  returned.multipath_error_m = {1e-3f, 1e-3f};
  returned.indirect_share = {0.1f, 0.2f};
  MeasuredPart part = rendered_frame(taken, {0, 0.0, 0, "", {}}, {Format::png});
  REQUIRE(part.record.bounces);
  CHECK(part.record.bounces->lines == 100);
  std::vector<std::string> names;
  for (const FileToWrite &file : part.files(part.record))
    names.push_back(file.name);
  std::ranges::sort(names);
  CHECK(names == std::vector<std::string>{"pmd_0000.cloud.png", "pmd_0000.distance_m.png",
                                          "pmd_0000.indirect_share.png", "pmd_0000.multipath_m.png"});
}
