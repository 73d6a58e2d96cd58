#include "host/output/files/accuracy_record.h"

#include <optional>
#include <stdexcept>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json json_of(const std::optional<double> &error) {
  return error ? ordered_json(*error) : ordered_json(nullptr);
}

} // namespace

std::string mode_name(Mode mode) {
  switch (mode) {
  case Mode::exact:
    return "exact";
  case Mode::reduced:
    return "reduced";
  case Mode::automatic:
    return "auto";
  }
  throw std::logic_error("a mode of no kind");
}

std::string precision_name(Precision precision) { return precision == Precision::fp64 ? "fp64" : "fp32"; }

ordered_json accuracy_json(const AccuracyReport &report) {
  return {{"precision", precision_name(report.precision)},
          {"diodes", report.diodes},
          {"error_claimed_m", json_of(report.claimed_m)},
          {"error_found_m", json_of(report.found_m)},
          {"amplitude_error_claimed", json_of(report.claimed_amplitude)},
          {"amplitude_error_found", json_of(report.found_amplitude)},
          {"checked_pixels", report.checked_pixels},
          {"check_ms", report.check_ms}};
}

} // namespace pmdsim
