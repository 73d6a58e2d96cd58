#include "engine/model/error.h"
#include "host/capture/capture.h"
#include "host/capture/variant_table.h"
#include "host/commands/commands.h"
#include "host/commands/report_of_run.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <optional>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// NaN counts as nothing hit.
double mean_coverage(const std::vector<float> &coverage) {
  const auto add = [](double sum, float share) {
    return std::isnan(share) ? sum : sum + static_cast<double>(share);
  };
  return std::accumulate(coverage.begin(), coverage.end(), 0.0, add) / static_cast<double>(coverage.size());
}

// Nothing of a channel that is not there.
std::string spread_line(const std::string &quantity, const std::vector<float> &values,
                        const std::string &unit) {
  if (values.empty())
    return {};
  const auto [min, median, max] = spread_of(values);
  return fmt::format("{:<24}{:>12}{:>12}{:>12}  {}\n", quantity, table_number(min), table_number(median),
                     table_number(max), unit);
}

std::string frame_text(const TakenFrame &taken, std::uint32_t frame) {
  const auto &[sensor, measurement, mode, normals, warnings] = taken;
  std::string text = fmt::format("{}, frame {}, {:.3f} ms\n", sensor.name, frame, measurement.frame_ms);
  const std::string head = fmt::format("{:<24}{:>12}{:>12}{:>12}\n", "", "min", "median", "max");
  std::string lines;
  for (std::size_t i = 0; i < measurement.returns.size(); ++i) {
    const std::string at = frequency_of(i, sensor.modulation_hz.size())
                               ? " at " + frequency_text(sensor.modulation_hz[i])
                               : std::string();
    lines += spread_line("distance" + at, measurement.returns[i].distance_m, "m");
    lines += spread_line("amplitude" + at, measurement.returns[i].amplitude, "W/(m² sr)");
    lines += spread_line("multipath" + at, measurement.returns[i].multipath_m, "m");
  }
  if (!lines.empty())
    text += head + lines;
  if (!measurement.coverage.empty())
    text +=
        fmt::format("{:.2f} % of the samples hit the scene\n", 100.0 * mean_coverage(measurement.coverage));
  if (measurement.bounces)
    text += bounces_text(*measurement.bounces) + "\n";
  return text + accuracy_text(mode, measurement.accuracy) + "\n";
}

// Beside its own files a frame names the manifest, which says how to read them.
ordered_json frame_told(const ordered_json &of_sensor, const FrameSequence &sequence) {
  ordered_json json = told_json(of_sensor);
  json["outputs"] = array_of(of_sensor.at("manifest").at("outputs"),
                             [&](const std::string &name) { return sequence.path_of(name); });
  json["outputs"].push_back(sequence.path_of(manifest_name));
  return json;
}

void print_render_json(const Capture &capture, const std::string &report) {
  const RunHead &run = capture.sequence().run();
  ordered_json head{{"device", run.device}, {"mode", mode_name(run.accuracy.mode)}};
  if (!report.empty())
    head["report"] = report;
  JsonPieces pieces([](std::string_view text) { print(std::string(text)); }, head);
  pieces.list("frames", [&](const JsonPieces::Add &add) {
    capture.for_each_sensor_frame(
        [&](const ordered_json &of_sensor) { add(frame_told(of_sensor, capture.sequence())); });
  });
  pieces.list("sheets", [&](const JsonPieces::Add &add) {
    for (const std::string &name : capture.sequence().sheets())
      add(capture.sequence().path_of(name));
  });
  pieces.end();
}

std::size_t bytes_of_largest(const Capture &capture) {
  return bytes_of_largest_frame(capture.setup(), true, capture.channels(), 0,
                                capture.output_precision() == OutputPrecision::float64);
}

// Writes all frames and returns what is to be said of the first that is made here.
std::string render(Capture &capture) {
  std::string text;
  std::optional<std::uint32_t> first;
  const auto measure = [&](const SensorFrame &at) {
    const auto taken = capture.share(capture.take(at, Light::beside_lens, at.next_s));
    if (at.frame == first.value_or(at.frame))
      text += frame_text(*taken, at.frame);
    first = first.value_or(at.frame);
    return rendered_frame(taken, at, capture.formats(), capture.setup().start.scene.objects);
  };
  capture.write(measure, bytes_of_largest(capture));
  return text;
}

// Writes all frames; their records tell what is in the table of variants.
void render_variant(Capture &capture, const std::string &name) {
  const auto measure = [&](const SensorFrame &at) {
    const auto taken = capture.share(capture.take(at, Light::beside_lens, at.next_s, ", variant " + name));
    MeasuredPart part = rendered_frame(taken, at, capture.formats(), capture.setup().start.scene.objects);
    return MeasuredPart{part.record, [taken, files = std::move(part.files)](FrameRecord &record) {
                          record.told = frame_summary(taken->measurement);
                          return files(record);
                        }};
  };
  capture.write(measure, bytes_of_largest(capture));
}

ordered_json variant_json(const Variant &variant, const Capture &capture) {
  ordered_json frames = ordered_json::array();
  capture.for_each_sensor_frame(
      [&](const ordered_json &of_sensor) { frames.push_back(frame_told(of_sensor, capture.sequence())); });
  return {{"name", variant.name}, {"changes", variant.changes}, {"frames", frames}};
}

// What is wrong with any of them is told before the first is measured. Returns those of the shard.
std::vector<Variant> checked_variants(const Options &options, SetupLoader &loader) {
  std::vector<SetupDocument> documents;
  for (const std::filesystem::path &file : options.setups)
    documents.push_back(requested_document(options.capture, file));
  const std::vector<Variant> all = variants_of(documents, options.variants);
  std::vector<Variant> own;
  for (std::size_t i = 0; i < all.size(); ++i) {
    try {
      CaptureRequest request = options.capture;
      request.shard = {};
      require_measurable(request, loader.load(all[i].document));
    } catch (const Error &error) {
      throw Error(error.code(), fmt::format("{}, in variant {}", error.what(), all[i].name), error.where());
    }
    if (i % options.capture.shard.count == options.capture.shard.index)
      own.push_back(all[i]);
  }
  return own;
}

// Shards that write to one directory have a table each.
std::string table_name(const Shard &shard) {
  return shard.count == 1 ? "table.csv" : fmt::format("table.{}-of-{}.csv", shard.index, shard.count);
}

void run_variants(const Options &options) {
  SetupLoader loader;
  const std::vector<Variant> variants = checked_variants(options, loader);
  const auto camera = std::make_shared<Camera>(options.capture.device);
  const std::filesystem::path &directory = options.capture.output_directory;
  VariantTable table(variants);
  ordered_json json{{"device", camera->device()},
                    {"mode", mode_name(options.capture.accuracy.mode)},
                    {"variants", ordered_json::array()}};
  for (const Variant &variant : variants) {
    CaptureRequest request = options.capture;
    request.shard = {};
    request.output_directory = directory / variant.name;
    Capture capture(request, requested_setup(request, variant.document, loader), "render", true,
                    request.channels, camera);
    render_variant(capture, variant.name);
    report_of_run(options, capture);
    capture.for_each_sensor_frame([&](const ordered_json &of_sensor) { table.add(variant, of_sensor); });
    if (options.json)
      json["variants"].push_back(variant_json(variant, capture));
  }
  const std::string written = table.empty() ? "" : table.write(directory, table_name(options.capture.shard));
  json["table"] = written;
  print(options.json
            ? json_text(json)
            : fmt::format("device    {} ({})\n\n{}\nwritten:\n  {}, a folder for each variant beside it\n",
                          camera->device(), camera->driver(), table.text(), written));
}

} // namespace

void run_render(const Options &options) {
  if (!options.setups.empty())
    return run_variants(options);
  Capture capture(options.capture, "render", true);
  const std::string text = render(capture);
  const std::string report = report_of_run(options, capture);
  if (options.json)
    print_render_json(capture, report);
  else
    print(capture.device_text() + text + capture.sequence().written_text() + report_line(report));
}

} // namespace pmdsim
