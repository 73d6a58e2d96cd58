// The folder of a run as others may have left it: run.json, a frame's record and the manifest, parted by
// lines of four dashes, beside a frame's file. It is read as report, merge and --resume do.

#include "tests/fuzz/target.h"

#include "host/output/page/run_content.h"
#include "host/output/run/frame_records.h"
#include "host/output/run/run_identity.h"

#include <array>

using namespace pmdsim;

namespace {

constexpr std::string_view separator = "\n----\n";

std::array<std::string_view, 3> parts_of(std::string_view text) {
  std::array<std::string_view, 3> parts;
  for (std::string_view &part : parts) {
    const std::size_t end = std::min(text.find(separator), text.size());
    part = text.substr(0, end);
    text.remove_prefix(std::min(end + separator.size(), text.size()));
  }
  return parts;
}

void read_again(const std::filesystem::path &folder) {
  const RunFile of_run = read_run_file(folder);
  const nlohmann::ordered_json inputs{{{"file", "wall.gltf"}, {"bytes", 1}}, {{"file", "led.csv"}}};
  for (const auto &[key, value] :
       {std::pair{"setup", nlohmann::ordered_json{{"sensors", 1}}}, {"inputs", inputs}}) {
    RunIdentity other = of_run.run;
    other.head[key] = value;
    fuzz::check_line(difference_text(of_run.run, other));
    fuzz::check_line(difference_text(other, of_run.run));
  }
  for (const std::uint32_t frame : recorded_frames(folder))
    if (const auto record = read_record(folder, frame, of_run.run.hash)) {
      has_warnings(*record);
      has_its_files(folder, *record);
      for (const nlohmann::ordered_json &sensor : record->at("sensors"))
        static_cast<void>(told_json(sensor).dump());
    }
}

void read_for_page(const std::filesystem::path &folder) {
  const RunContent run = read_run(folder, FrameRange{0, 9});
  for (const PageSensor &sensor : run.sensors)
    for (const PageFrame &frame : sensor.frames)
      static_cast<void>(times_of(run, sensor.name, frame.number).dump());
}

} // namespace

FUZZ_TARGET(run) {
  const auto [run, record, manifest] = parts_of(fuzz::text_of(data, size));
  fuzz::write_file("run.json", run);
  fuzz::write_file("0007.record.json", record);
  fuzz::write_file("manifest.json", manifest);
  fuzz::accepts([] { read_again(fuzz::folder()); });
  fuzz::accepts([] { read_for_page(fuzz::folder()); });
  return 0;
}
