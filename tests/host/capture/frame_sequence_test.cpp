// The files that a sequence leaves in its directory, with frames made of words instead of measurements.

#include "engine/model/error.h"
#include "host/capture/frame_sequence.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <tbb/info.h>
#include <thread>
#include <vector>

using namespace pmdsim;

namespace {

using namespace std::chrono_literals;

constexpr std::size_t few_bytes = 1000;

// Sensors "a", "b", ... and frames a tenth of a second apart.
Setup words(std::uint32_t frames, std::size_t sensors) {
  Setup setup;
  setup.frames = {0.0, 10.0, frames};
  for (std::size_t i = 0; i < sensors; ++i) {
    Sensor sensor;
    sensor.name = std::string(1, static_cast<char>('a' + i));
    setup.start.sensors.push_back(sensor);
  }
  return setup;
}

std::string file_name(const SensorFrame &at, const std::string &sensor) {
  return fmt::format("{}_{:04}.txt", sensor, at.frame);
}

class Sequence {
public:
  Sequence(std::uint32_t frames, std::size_t sensors)
      : setup_(words(frames, sensors)),
        sequence_(std::in_place, setup_, SequenceRequest{{0, frames}, directory()},
                  RunHead{.command = "render"}) {}

  std::filesystem::path directory() const { return folder_.path() / "out"; }

  using Write = std::function<void(const SensorFrame &, OutputFile &)>;
  // One file a sensor and frame.
  void write(const Write &write_file, std::size_t part_bytes = few_bytes) {
    const auto measure = [&](const SensorFrame &at) -> MeasuredPart {
      measured.push_back(at);
      const Sensor &sensor = setup_.start.sensors[at.sensor];
      return {{sensor, at.frame, at.time_s, 0.0, {}, Mode::exact, {}},
              [at, &write_file, name = sensor.name](FrameRecord &) {
                return std::vector<FileToWrite>{
                    {file_name(at, name), [at, &write_file](OutputFile &file) { write_file(at, file); }}};
              }};
    };
    sequence_->begin();
    sequence_->write(measure, part_bytes);
  }

  void end() { sequence_.reset(); }

  // The files of the frames that the manifest lists.
  std::set<std::string> listed() const {
    std::set<std::string> names;
    const auto manifest = nlohmann::json::parse(content_of(directory() / "manifest.json"));
    for (const auto &frame : manifest.at("frames"))
      names.insert(frame.at("outputs").begin(), frame.at("outputs").end());
    return names;
  }

  std::vector<SensorFrame> measured;

private:
  pmdsim::test::TemporaryFolder folder_;
  Setup setup_;
  std::optional<FrameSequence> sequence_;
};

// Early frames take longest to write, so that those after them are ready before.
void write_slowly(const SensorFrame &at, OutputFile &file) {
  std::this_thread::sleep_for(at.frame % 3 == 0 ? 10ms : 1ms);
  file.write(fmt::format("frame {} of sensor {}", at.frame, at.sensor));
}

void fail_to_write(const SensorFrame &at, OutputFile &file) {
  file.write("half");
  throw Error(ExitCode::output, fmt::format("frame {}: disk full", at.frame));
}

} // namespace

TEST_CASE("parts are measured frame by frame and sensor by sensor, each with the time of the next") {
  Sequence sequence(2, 2);
  sequence.write(write_slowly);
  REQUIRE(sequence.measured.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(sequence.measured[i].frame == i / 2);
    CHECK(sequence.measured[i].sensor == i % 2);
  }
  CHECK(sequence.measured[0].next_s == 0.0);
  CHECK(sequence.measured[1].next_s == 0.1);
  CHECK_FALSE(sequence.measured[3].next_s);
  CHECK(content_of(sequence.directory() / "b_0001.txt") == "frame 1 of sensor 1");
  CHECK(sequence.listed() == std::set<std::string>{"a_0000.txt", "b_0000.txt", "a_0001.txt", "b_0001.txt"});
}

TEST_CASE("a frame appears after those before it, with the files of all its sensors") {
  Sequence sequence(12, 2);
  std::atomic<bool> in_order = true;
  sequence.write([&](const SensorFrame &at, OutputFile &file) {
    write_slowly(at, file);
    const std::set<std::string> names = names_in(sequence.directory());
    for (std::uint32_t frame = 1; frame < 12; ++frame)
      if (names.contains(fmt::format("a_{:04}.txt", frame)) &&
          !names.contains(fmt::format("b_{:04}.txt", frame - 1)))
        in_order = false;
    if (names.contains(fmt::format("a_{:04}.txt", at.frame)))
      in_order = false;
  });
  CHECK(in_order);
  CHECK(sequence.listed().size() == 24);
}

TEST_CASE("a file that cannot be written leaves the frames before it, even those that take longer") {
  const std::uint32_t failing = GENERATE(0u, 1u, 4u, 7u);
  Sequence sequence(8, 2);
  const auto write = [&] {
    sequence.write([&](const SensorFrame &at, OutputFile &file) {
      if (at.frame >= failing && at.sensor == 1)
        fail_to_write(at, file);
      write_slowly(at, file);
    });
  };
  const std::string error = fmt::format("frame {}: disk full", failing);
  if (failing == 0) {
    CHECK_THROWS_WITH(write(), error);
    sequence.end();
    CHECK_FALSE(std::filesystem::exists(sequence.directory()));
    return;
  }
  CHECK_THROWS_WITH(write(), Catch::StartsWith(error + "; frame"));
  std::set<std::string> expected;
  for (std::uint32_t frame = 0; frame < failing; ++frame)
    expected.insert({fmt::format("a_{:04}.txt", frame), fmt::format("b_{:04}.txt", frame)});
  CHECK(sequence.listed() == expected);
  for (std::uint32_t frame = 0; frame < failing; ++frame)
    expected.insert(fmt::format("{:04}.record.json", frame));
  expected.insert({"manifest.json", "run.json"});
  CHECK(names_in(sequence.directory()) == expected);
}

TEST_CASE("parts wait to be written as far as memory goes") {
  const auto cores = static_cast<std::size_t>(tbb::info::default_concurrency());
  CHECK(parts_waiting(few_bytes) == cores);
  CHECK(parts_waiting(0) == cores);
  CHECK(parts_waiting(std::size_t{900} << 20) == 1);
  CHECK(parts_waiting(std::size_t{1100} << 20) == 0);
}

TEST_CASE("a part that is too large to wait is written before the next is measured") {
  Sequence sequence(4, 1);
  std::size_t measured_before_written = 0;
  sequence.write(
      [&](const SensorFrame &at, OutputFile &) {
        std::this_thread::sleep_for(5ms);
        measured_before_written = std::max(measured_before_written, sequence.measured.size() - at.frame);
      },
      std::size_t{2} << 30);
  CHECK(measured_before_written == 1);
}
