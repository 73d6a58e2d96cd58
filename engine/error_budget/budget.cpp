#include "engine/error_budget/budget.h"

#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

// The amplitude only where it is asked for.
std::string errors_text(double distance_m, double amplitude, const Accuracy &asked_for) {
  const std::string distance = fmt::format("{:.6g} mm", 1e3 * distance_m);
  return std::isfinite(asked_for.max_amplitude_error)
             ? fmt::format("{} and {:.3g} of the amplitude", distance, amplitude)
             : distance;
}

std::string limits_text(const Accuracy &asked_for) {
  return errors_text(asked_for.max_error_m, asked_for.max_amplitude_error, asked_for);
}

} // namespace

std::optional<std::string> promise_breach(const shader::BrokenPromise &broken, const AccuracyReport &found,
                                          const Accuracy &asked_for, double ambiguity_m) {
  if (broken.returns > 0)
    return fmt::format("{} returns of pixels cancel in part, or are weak beside what rounding does to them, "
                       "and may be off by up to {}; expected at most {}",
                       broken.returns,
                       errors_text(static_cast<double>(std::bit_cast<float>(broken.worst_m)),
                                   static_cast<double>(std::bit_cast<float>(broken.amplitude)), asked_for),
                       limits_text(asked_for));
  const double found_m = found.found_m.value_or(0.0), amplitude = found.found_amplitude.value_or(0.0);
  // What is compared is rounded to float itself.
  const double rounding_m = 0x1p-24 * ambiguity_m;
  if (found_m > asked_for.max_error_m + rounding_m || amplitude > asked_for.max_amplitude_error + 0x1p-23)
    return fmt::format("pixels evaluated exactly are off by up to {}; expected at most {}",
                       errors_text(found_m, amplitude, asked_for), limits_text(asked_for));
  return std::nullopt;
}

} // namespace pmdsim
