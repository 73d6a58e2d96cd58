// From a simulator to a frame.

#include "host/library/calls.h"
#include "host/library/objects.h"
#include "host/output/files/manifest.h"
#include "host/report/frame_findings.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

namespace pmdsim::library {
namespace {

template <class Value>
Value named(const std::map<std::string, Value> &values, const char *name, const char *text) {
  const auto found = values.find(text);
  if (found == values.end()) {
    std::string known;
    for (const auto &[each, value] : values)
      known += (known.empty() ? "" : " or ") + each;
    throw bad_argument(fmt::format("{}: expected {}, found \"{}\"", name, known, text));
  }
  return found->second;
}

// 0: none is given.
std::optional<double> error_of(double error, double largest, const char *name) {
  if (error == 0.0)
    return std::nullopt;
  if (!(error > 0.0 && error <= largest))
    throw bad_argument(
        fmt::format("{}: expected a number above 0, at most {}, found {}", name, largest, error));
  return error;
}

void check_exact(const Accuracy &accuracy, bool is_bounded, bool on_reference) {
  if (accuracy.mode == Mode::exact && is_bounded)
    throw bad_argument("mode: exact keeps no bound, expected reduced or auto beside an error");
  if (on_reference && (accuracy.mode != Mode::exact || accuracy.precision == Precision::fp32))
    throw bad_argument("the reference measures in mode exact and precision fp64 alone");
}

Accuracy accuracy_of(const pmdsim_render_options &options, bool on_reference) {
  constexpr double largest_error_m = 1e6;
  const std::map<std::string, Mode> modes{
      {"exact", Mode::exact}, {"reduced", Mode::reduced}, {"auto", Mode::automatic}};
  const std::map<std::string, Precision> precisions{{"fp32", Precision::fp32}, {"fp64", Precision::fp64}};
  Accuracy accuracy;
  const auto error_m = error_of(options.max_error_m, largest_error_m, "max_error_m");
  const auto amplitude_error = error_of(options.max_amplitude_error, 1.0, "max_amplitude_error");
  accuracy.max_error_m = error_m.value_or(accuracy.max_error_m);
  accuracy.max_amplitude_error = amplitude_error.value_or(accuracy.max_amplitude_error);
  if (options.mode)
    accuracy.mode = named(modes, "mode", options.mode);
  else if (error_m || amplitude_error)
    accuracy.mode = Mode::automatic;
  if (options.precision)
    accuracy.precision = named(precisions, "precision", options.precision);
  accuracy.strict = options.strict != 0;
  check_exact(accuracy, error_m || amplitude_error, on_reference);
  return accuracy;
}

std::optional<SampleChoice> samples_of(const char *text) {
  if (!text)
    return std::nullopt;
  const std::string_view written(text);
  if (written == "auto")
    return automatic_samples;
  std::uint32_t samples = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), samples);
  if (error != std::errc() || end != written.data() + written.size() || samples < 1 || samples > 16)
    throw bad_argument(fmt::format("samples: expected 1 to 16, or auto, found \"{}\"", written));
  return SampleChoice{.samples = samples};
}

std::uint32_t paths_of(std::uint32_t paths, bool on_reference) {
  constexpr std::uint32_t fewest = 16, largest = 1'000'000'000;
  if (paths != 0 && (paths < fewest || paths > largest || !on_reference))
    throw bad_argument(fmt::format("paths: expected 0, or {} to {} on the device reference, found {}", fewest,
                                   largest, paths));
  return paths;
}

// NULL: all.
WantedChannels channels_of(const char *text) {
  if (!text)
    return {};
  std::vector<std::string> names;
  for (std::string_view rest = text;;) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    names.emplace_back(rest.substr(0, end));
    if (end == rest.size())
      return WantedChannels(names);
    rest.remove_prefix(end + 1);
  }
}

OutputPrecision output_precision_of(const char *text) {
  const std::map<std::string, OutputPrecision> precisions{{"float32", OutputPrecision::float32},
                                                          {"float64", OutputPrecision::float64}};
  return text ? named(precisions, "output_precision", text) : OutputPrecision::float32;
}

RenderRequest request_of(const pmdsim_render_options *given, bool on_reference) {
  const pmdsim_render_options options =
      given ? struct_of(given, sizeof(pmdsim_render_options), "options") : pmdsim_render_options{};
  return {accuracy_of(options, on_reference), samples_of(options.samples),
          paths_of(options.paths, on_reference), channels_of(options.channels),
          output_precision_of(options.output_precision)};
}

// The place of each is the sensor, or the setup.
std::vector<Warning> warnings_of(const TakenFrame &taken, const Setup &setup, const Accuracy &asked) {
  std::vector<Warning> warnings = frame_warnings(setup, taken.sensor, taken.measurement, asked);
  if (taken.mode == Mode::exact && asked.mode != Mode::exact)
    warnings.insert(warnings.begin(), tap_by_tap_warning(setup));
  return warnings;
}

nlohmann::ordered_json report_of(const TakenFrame &taken, std::uint32_t frame, const Setup &setup,
                                 const Accuracy &asked) {
  const Measurement &measured = taken.measurement;
  nlohmann::ordered_json json =
      frame_json({taken.sensor, frame, setup.frames.time_s(frame), measured.frame_ms, measured.passes,
                  taken.mode, measured.accuracy, measured.bounces});
  json.erase("outputs");
  json["frame_ms"] = measured.frame_ms;
  json["passes_ms"] = passes_json(measured.passes);
  json["check_ms"] = measured.accuracy.check_ms;
  json["warnings"] = array_of(warnings_of(taken, setup, asked), warning_json);
  return json;
}

} // namespace
} // namespace pmdsim::library

using namespace pmdsim;
using namespace pmdsim::library;

pmdsim_status pmdsim_render(pmdsim_simulator *simulator, uint32_t sensor, uint32_t frame,
                            const pmdsim_render_options *options, pmdsim_frame **result) {
  return guarded([&] {
    required(result, "result");
    const InCall in(simulator);
    Session &session = in->session;
    if (!session.has_setup())
      throw bad_argument("the simulator has no setup");
    const RenderRequest request = request_of(options, session.camera()->is_reference());
    if (request.accuracy.strict)
      refuse_warnings(session.setup().warnings);
    const Progress stop_when_cancelled = [&cancelled = in->cancelled](double) {
      if (cancelled)
        throw Error(ExitCode::interrupted, "cancelled");
    };
    auto made = std::make_shared<FrameObject>();
    made->camera = session.camera();
    made->taken = session.take(sensor, frame, request, stop_when_cancelled);
    if (request.accuracy.strict)
      refuse_warnings(warnings_of(*made->taken, session.setup(), request.accuracy));
    made->channels = pmdsim::channels_of(made->taken->measurement);
    made->report = json_text(report_of(*made->taken, frame, session.setup(), request.accuracy));
    *result = add_frame(std::move(made));
  });
}
