#include "host/report/report.h"

#include "engine/model/error.h"
#include "host/output/files/manifest.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <mutex>
#include <set>
#include <system_error>

namespace pmdsim {
namespace {

template <typename T>
Spread spread(std::span<const T> values) {
  std::vector<T> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](T value) { return std::isfinite(value); });
  if (finite.empty()) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none};
  }
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::nth_element(finite.begin(), middle, finite.end());
  const auto [min, max] = std::minmax_element(finite.begin(), finite.end());
  return {static_cast<double>(*min), static_cast<double>(*middle), static_cast<double>(*max)};
}

// "at most 1.2 µm, 3e-06 of the amplitude".
std::string bounds_text(const std::optional<double> &distance_m, const std::optional<double> &amplitude) {
  std::vector<std::string> errors;
  if (distance_m)
    errors.push_back(micrometres_text(*distance_m));
  if (amplitude)
    errors.push_back(fmt::format("{:.3g} of the amplitude", *amplitude));
  return fmt::format("at most {}", fmt::join(errors, " and "));
}

} // namespace

void print(const std::string &text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw Error(
        errno == EPIPE ? nobody_reads : ExitCode::output,
        fmt::format("standard output: cannot be written: {}", std::generic_category().message(errno)));
}

std::string frequency_text(double modulation_hz) { return fmt::format("{:.10g} MHz", modulation_hz / 1e6); }

void warn(const Warning &warning) {
  static std::set<std::string> told; // variants and sensors of a run may warn of the same
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  if (told.insert(warning.code + '\n' + warning.place + '\n' + warning.text).second)
    tell(fmt::format("warning: {}: {} [{}]", warning.place, warning.text, warning.code));
}

void tell(const std::string &text) { std::fputs(fmt::format("pmdsim: {}\n", text).c_str(), stderr); }

std::string place_of(const Sensor &sensor) { return "sensor " + sensor.name; }

std::string table_number(double value) { return std::isnan(value) ? "-" : fmt::format("{:#.6g}", value); }

std::string micrometres_text(double length_m) { return fmt::format("{:.4g} µm", 1e6 * length_m); }

std::string sum_text(Mode mode, const AccuracyReport &report) {
  return fmt::format("{}, {}, {} diode{} summed", mode_name(mode), precision_name(report.precision),
                     report.diodes, report.diodes == 1 ? "" : "s");
}

std::string errors_text(const AccuracyReport &report) {
  std::vector<std::string> errors;
  if (report.claimed_m || report.claimed_amplitude)
    errors.push_back(bounds_text(report.claimed_m, report.claimed_amplitude) + " claimed");
  if (report.found_m || report.found_amplitude)
    errors.push_back(fmt::format("{} found in {} pixels, checked in {:.3f} ms",
                                 bounds_text(report.found_m, report.found_amplitude), report.checked_pixels,
                                 report.check_ms));
  return fmt::format("{}", fmt::join(errors, ", "));
}

std::optional<Warning> unpromised_warning(const AccuracyReport &report, double max_error_m,
                                          const Sensor &sensor) {
  if (report.unpromised == 0)
    return std::nullopt;
  return Warning{
      warning_code("error-above-asked"), place_of(sensor),
      fmt::format("{} return{} of pixels may be off by more than {:.6g} mm, each by what the channel "
                  "error_bound_m says; --strict refuses such frames",
                  report.unpromised, report.unpromised == 1 ? "" : "s", 1e3 * max_error_m)};
}

std::string bounces_text(const BouncesReport &report) {
  const std::string source = fmt::format("from {} elements and {} lines", report.elements, report.lines);
  return std::isnan(report.claimed_m)
             ? "multipath " + source
             : fmt::format("multipath error at most {:.3g} mm in 95 % of the pixels, estimated, {}",
                           1e3 * report.claimed_m, source);
}

std::string accuracy_text(Mode mode, const AccuracyReport &report) {
  std::string text;
  if (mode != Mode::exact || report.precision == Precision::fp64)
    text += fmt::format("mode {}\n", sum_text(mode, report));
  if (const std::string errors = errors_text(report); !errors.empty())
    text += fmt::format("error {}\n", errors);
  return text;
}

Spread spread_of(std::span<const float> values) { return spread(values); }
Spread spread_of(std::span<const double> values) { return spread(values); }

} // namespace pmdsim
