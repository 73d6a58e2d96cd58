#include "host/output/page/report_page.h"

#include "host/output/files/output_file.h"
#include "host/output/page/page_data.h"
#include "host/output/page/page_text.h"
#include "host/output/pictures/colour_map.h"

#include <algorithm>
#include <fmt/format.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr double mib = 1024.0 * 1024.0;
constexpr std::size_t largest_page_bytes = std::size_t{1} << 28; // whatever was asked for

// Three lists, red, green and blue, from 0 to 1.
ordered_json colours_json() {
  return {{"sequential", viridis.levels},
          {"zero_centred", blue_white_red.levels},
          {"turn", twilight.levels},
          {"none", no_value_colour}};
}

// "room/render" of "out/room/render".
std::string short_name(const fs::path &directory) {
  fs::path whole = fs::absolute(directory).lexically_normal();
  if (!whole.has_filename())
    whole = whole.parent_path();
  const fs::path parent = whole.parent_path().filename();
  return (parent / whole.filename()).string();
}

} // namespace

WrittenReport write_report(const ReportRequest &request, const std::function<void()> &check) {
  if (!request.file.empty())
    refuse_what_is_no_file(request.file);
  RunContent run = read_run(request.directory, request.frames);
  const std::string head_text = run.head.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  const std::size_t around = page_html.size() + page_style.size() + page_script.size() + head_text.size();
  const auto most = static_cast<std::size_t>(request.max_mib * mib);
  const std::size_t wanted = most > around ? most - around : 0;
  PageData data = page_data(run, {wanted, std::max(largest_page_bytes, 4 * wanted)}, check);

  const fs::path path = request.file.empty() ? request.directory / report_name : request.file;
  WrittenReport written{path.string(), 0, data.frames, left_out_text(data.plan, data.frames, data.channels)};
  const ordered_json json{{"title", short_name(request.directory)}, {"head", std::move(run.head)},
                          {"sensors", std::move(data.sensors)},     {"colours", colours_json()},
                          {"pixel_step", data.plan.pixel_step},     {"left_out", written.left_out}};
  check();
  OutputFile file(path);
  write_page(json, data.blocks, [&](std::string_view text) { file.write(text); });
  file.sync();
  file.close();
  file.publish();
  written.bytes = file.size_bytes();
  return written;
}

ordered_json report_json(const WrittenReport &report) {
  return {{"report", report.file},
          {"bytes", report.bytes},
          {"frames", report.frames},
          {"left_out", report.left_out}};
}

} // namespace pmdsim
