#include "host/bench/results.h"
#include "host/bench/table.h"
#include "host/output/files/manifest.h"

#include <fmt/format.h>
#include <string>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

std::string part_text(const ordered_json &part) { return fmt::format("{:.3f}", number_or_nan(part)); }

std::string mebibytes(const ordered_json &bytes) {
  return bytes.is_null() ? "-" : fmt::format("{:.0f}", bytes.get<double>() / (1 << 20));
}

std::string micrometres(const ordered_json &length_m) { return number<3>(1e6 * number_or_nan(length_m)); }

// The rows of modes or, where `swept`, of a sweep's points.
ordered_json results_of(const ordered_json &json, bool swept) {
  ordered_json rows = ordered_json::array();
  for (const ordered_json &row : json["results"])
    if (row.contains("sweep") == swept)
      rows.push_back(row);
  return rows;
}

std::string machine_text(const BenchReport &report) {
  const Machine &machine = report.machine;
  std::string text =
      fmt::format("    {}\n\nDevice: {} ({}). Processor: {}, {} threads, {} of them used. "
                  "Program: pmdsim {}, {}, {}. Pass times by {}.",
                  report.command, machine.device, machine.driver, machine.processor, machine.hardware_threads,
                  machine.threads, machine.version, machine.compiler, machine.build,
                  machine.passes_by == "clock" ? "the clock" : "the device's timestamps");
  std::vector<std::string> set;
  for (const auto &[name, value] : machine.environment.items())
    if (!value.is_null())
      set.push_back(fmt::format("{}={}", name, value.get<std::string>()));
  return text + fmt::format(" Environment: {}. Samples a pixel: {}.\n",
                            set.empty() ? "nothing set" : fmt::format("{}", fmt::join(set, " ")),
                            fmt::join(report.samples, ", "));
}

std::string error_text(const AccuracyCheck &check, Mode mode) {
  const std::string what = fmt::format("- mode {}, sensor {} at {}: ", mode_name(mode), check.sensor,
                                       frequency_text(check.modulation_hz));
  if (check.comparable == 0)
    return what + "nothing to compare, the reference is dark in every pixel\n";
  if (check.pixels == 0)
    return what + "nothing to compare, rounding decides about the light of every pixel\n";
  return what + fmt::format("off the reference by at most {} over {} pixels of {} x {}\n",
                            micrometres_text(check.distance_max_m), check.pixels, check.resolution.x,
                            check.resolution.y);
}

std::string modes_text(const SetupBench &bench, ordered_json rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i]["sum"] = sum_text(bench.modes[i].mode, timing_of(bench.modes[i].frames).accuracy);
  return table_text({column(bench.name, "/mode", plain), column("frame, ms", "/frame_ms", ms_text),
                     from_to("least to most", "/frame_ms_min", "/frame_ms_max", ms_text),
                     column("frames/s", "/frames_per_s", number<4>),
                     column("interactions/s in accumulate", "/interactions_per_s", number<4>),
                     column("passes / frame", "/passes_explain", part_text),
                     column("first frame, ms", "/first_frame_ms", ms_text),
                     column("prepare, ms", "/prepare_ms", ms_text), column("sum", "/sum", plain)},
                    rows);
}

// A column for each mode, a row for each pass that any of them has.
std::string passes_text(const ordered_json &modes) {
  ordered_json rows = ordered_json::object();
  std::vector<Column> columns{column("pass, ms", "/pass", plain)};
  for (const ordered_json &mode : modes) {
    const auto name = mode["mode"].get<std::string>();
    columns.push_back(
        {name, [name](const ordered_json &row) { return row.contains(name) ? part_text(row[name]) : "-"; }});
    for (const auto &[pass, ms] : mode["passes_ms"].items()) {
      rows[pass]["pass"] = pass;
      rows[pass][name] = ms;
    }
  }
  return rows.empty() ? "" : "\n" + table_text(columns, rows);
}

std::string native_text(const ordered_json &native) {
  ordered_json rows = ordered_json::array({native});
  rows[0]["form"] = "moments";
  if (const ordered_json &series = native["series"]; !series.is_null()) {
    rows.push_back(series);
    rows[1]["form"] = fmt::format("series, {} powers", series["powers"].get<std::uint32_t>());
  }
  const std::string rates = "/interactions_per_s";
  return fmt::format("\nNative kernel: {}, {} threads, {} points x {} diodes, {}.\n\n",
                     plain(native["instructions"]), native["threads"].dump(), native["points"].dump(),
                     native["diodes"].dump(), plain(native["what"])) +
         table_text({column("native kernel", "/form", plain),
                     column("interactions/s", rates + "/median", number<3>),
                     from_to("least to most", rates + "/min", rates + "/max", number<3>),
                     column("off double by", "/error_max_m", micrometres_text)},
                    rows);
}

std::string ratios_text(const ordered_json &json) {
  ordered_json rows = ordered_json::array();
  for (const auto &[name, value] : json["ratios"].items())
    rows.push_back({{"name", name}, {"value", value}, {"rounds", json["ratios_of_rounds"][name]}});
  if (rows.empty())
    return "";
  return "\n" + table_text({column("ratio", "/name", plain), column("of medians", "/value", number<3>),
                            from_to("within a round", "/rounds/min", "/rounds/max", number<3>)},
                           rows);
}

std::string setup_text(const SetupBench &bench, const ordered_json &json) {
  const ordered_json modes = results_of(json, false);
  const std::string sensors = bench.sensors > 1 ? fmt::format(" of each of {} sensors", bench.sensors) : "";
  std::string text =
      fmt::format("\nMedians of {} warm frames{}, modes and native kernel in turn. Peak memory {} MiB.\n\n",
                  bench_rounds, sensors, mebibytes(json["peak_memory_bytes"])) +
      modes_text(bench, modes) + "\n";
  for (const ModeBench &mode : bench.modes) {
    for (const AccuracyCheck &check : mode.checks)
      text += error_text(check, mode.mode);
    if (const std::string errors = errors_text(timing_of(mode.frames).accuracy); !errors.empty())
      text += fmt::format("- mode {}: {}\n", mode_name(mode.mode), errors);
  }
  text += passes_text(modes);
  if (bench.native)
    text += native_text(json["native"]);
  return text + ratios_text(json);
}

std::string sequence_text(const ordered_json &sequence, Mode mode) {
  return fmt::format("\nA sequence of {} frames in mode {}, frames/s by the clock.\n\n",
                     sequence["frames"].dump(), mode_name(mode)) +
         table_text({column("not written", "/measured_per_s", number<4>),
                     column("as NPY", "/npy_per_s", number<4>), column("as EXR", "/exr_per_s", number<4>)},
                    ordered_json::array({sequence}));
}

std::string sweep_text(const ordered_json &rows, Mode mode) {
  std::vector<Column> columns{column("sweep", "/name", plain), column("frame, ms", "/frame_ms", ms_text),
                              from_to("least to most", "/frame_ms_min", "/frame_ms_max", ms_text),
                              column("interactions/s", "/interactions_per_s", number<3>)};
  for (const std::string pass : {"visibility", "points", "accumulate", "resolve", "read_back"})
    columns.push_back(column(pass, "/passes_ms/" + pass, ms_text));
  columns.insert(columns.end(), {column("passes / frame", "/passes_explain", part_text),
                                 column("error, µm", "/error_found_m", micrometres),
                                 column("first frame, ms", "/first_frame_ms", ms_text),
                                 column("prepare, ms", "/prepare_ms", ms_text),
                                 column("peak, MiB", "/peak_memory_bytes", mebibytes)});
  return fmt::format("\nOne quantity at a time, mode {}; passes in ms.\n\n", mode_name(mode)) +
         table_text(columns, rows);
}

std::string suite_text(const ordered_json &rows, Mode mode) {
  const bool raced = rows.front().contains("peer");
  std::vector<Column> columns{column("scene", "/name", plain), column("triangles", "/triangles", number<7>),
                              column("frame, ms", "/frame_ms", ms_text),
                              from_to("least to most", "/frame_ms_min", "/frame_ms_max", ms_text)};
  if (raced)
    columns.insert(columns.end(),
                   {column("peer, ms", "/peer/frame_ms/median", ms_text),
                    from_to("least to most", "/peer/frame_ms/min", "/peer/frame_ms/max", ms_text),
                    column("times as fast as the peer", "/peer/speed_over_peer", number<3>)});
  for (const std::string pass : {"visibility", "points", "lit", "accumulate", "resolve", "read_back"})
    columns.push_back(column(pass, "/passes_ms/" + pass, ms_text));
  columns.insert(columns.end(), {column("first frame, ms", "/first_frame_ms", ms_text),
                                 column("prepare, ms", "/prepare_ms", ms_text),
                                 column("error, µm", "/error_found_m", micrometres),
                                 column("distances off", "/check/distances_off", number<7>),
                                 column("pairs", "/check/pairs", number<9>),
                                 column("apart", "/check/pairs_apart", number<9>),
                                 column("beyond rounding", "/check/pairs_beyond_rounding", number<9>)});
  return fmt::format(
             "\nProcedural scenes, mode {}; passes in ms. Checked: {} random pixels of each, and each of "
             "their pairs with a diode.\n\n",
             mode_name(mode), rows.front()["check"]["pixels"].dump()) +
         table_text(columns, rows);
}

std::string growth_text(const ordered_json &growth) {
  const std::string unit = plain(growth["unit"]);
  const double slope_ms = growth["slope_ms"];
  const auto percent = [](const ordered_json &over) {
    return fmt::format("{:+.1f} %", 100.0 * (number_or_nan(over) - 1.0));
  };
  const auto over_slope = [=](const ordered_json &ms) { return number<3>(number_or_nan(ms) / slope_ms); };
  return fmt::format("\nMedian frame time over {}: {} ms + {} ms each.\n\n", unit,
                     number<4>(growth["fixed_ms"]), number<4>(growth["slope_ms"])) +
         table_text(
             {{unit,
               [](const ordered_json &point) { return fmt::format("{:.0f}", number_or_nan(point["size"])); }},
              column("frame, ms", "/frame_ms", ms_text),
              column("over the line", "/over_line", percent),
              column("each more since the row before, ms", "/marginal_ms", number<4>),
              column("over the slope", "/marginal_ms", over_slope)},
             growth["points"]);
}

} // namespace

std::string bench_markdown(const BenchReport &report) {
  const ordered_json json = bench_json(report);
  const Mode mode = report.request.accuracy.mode;
  if (!report.suite.empty())
    return machine_text(report) + suite_text(json["results"], mode);
  std::string text = machine_text(report) + setup_text(report.setup, json);
  if (report.sequence)
    text += sequence_text(json["sequence"], mode);
  if (!report.sweep.empty()) {
    text += sweep_text(results_of(json, true), mode);
    for (const ordered_json &growth : json["linearity"])
      text += growth_text(growth);
  }
  return text;
}

} // namespace pmdsim
