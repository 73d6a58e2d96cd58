#include "host/command_line/accuracy_options.h"

#include "host/input/file/input_error.h"
#include "host/input/file/length.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <fmt/format.h>
#include <map>

namespace pmdsim {
namespace {

[[noreturn]] void refuse(const std::string &message) { throw Error(ExitCode::usage, message); }

double max_error_of(const std::string &text) {
  if (const auto error_m = length_m(text))
    return *error_m;
  refuse(fmt::format("--max-error: expected a length from {} m to {} m with its unit, m, mm or um, e.g. "
                     "0.1mm, found {}",
                     least_written_length_m, largest_written_length_m, in_quotes(text)));
}

double max_amplitude_error_of(const std::string &text) {
  const auto error = number_of(text);
  if (!error || !(*error > 0.0 && *error <= 1.0))
    refuse("--max-amplitude-error: expected a number above 0, at most 1, e.g. 1e-3, found " +
           in_quotes(text));
  return *error;
}

void check_exact(const WrittenAccuracy &written, const Accuracy &accuracy, bool on_reference) {
  if (accuracy.mode == Mode::exact && (written.max_error || written.max_amplitude_error))
    refuse(fmt::format("{}: mode exact sums every sample and diode and keeps no bound; expected --mode "
                       "reduced or auto beside it",
                       written.max_error ? "--max-error" : "--max-amplitude-error"));
  if (on_reference && accuracy.mode != Mode::exact)
    refuse(fmt::format("--device reference: expected mode exact, which is all that the reference does{}",
                       written.mode ? "" : "; an error that is bounded means mode auto"));
  if (on_reference && accuracy.precision == Precision::fp32)
    refuse("--device reference: expected precision fp64, which is all that the reference does");
}

} // namespace

void add_strict(CLI::App &command, WrittenAccuracy &written) {
  command.add_flag("--strict", written.strict,
                   "make every warning an error, exit code 3; and refuse frames some of whose pixels may be "
                   "off by more than was asked for, exit code 8, which are else written with the channel "
                   "error_bound_m");
}

void add_accuracy(CLI::App &command, WrittenAccuracy &written) {
  command
      .add_option("--mode", written.mode,
                  "exact: every sample and diode; reduced: few weighted diodes for all; auto: the cheapest "
                  "that keeps the error [exact, auto where an error is given; bench: all]")
      ->check(CLI::IsMember({"exact", "reduced", "auto"}));
  command.add_option("--max-error", written.max_error,
                     fmt::format("largest distance error, m, mm or um, e.g. 0.1mm [{:g}um]; exit code 8 "
                                 "where most pixels cannot keep it",
                                 1e6 * default_max_error_m));
  command.add_option("--max-amplitude-error", written.max_amplitude_error,
                     "largest relative amplitude error, e.g. 1e-3 [any]");
  add_strict(command, written);
  command
      .add_option("--precision", written.precision,
                  "of the sum over the diodes, fp32 or fp64 [fp32; auto: what the error takes]")
      ->check(CLI::IsMember({"fp32", "fp64"}));
}

Accuracy accuracy_of(const WrittenAccuracy &written, bool on_reference) {
  static const std::map<std::string, Mode> modes{
      {"exact", Mode::exact}, {"reduced", Mode::reduced}, {"auto", Mode::automatic}};
  static const std::map<std::string, Precision> precisions{{"fp32", Precision::fp32},
                                                           {"fp64", Precision::fp64}};
  Accuracy accuracy;
  if (written.max_error)
    accuracy.max_error_m = max_error_of(*written.max_error);
  if (written.max_amplitude_error)
    accuracy.max_amplitude_error = max_amplitude_error_of(*written.max_amplitude_error);
  if (written.precision)
    accuracy.precision = precisions.at(*written.precision);
  if (written.mode)
    accuracy.mode = modes.at(*written.mode);
  else if (written.max_error || written.max_amplitude_error)
    accuracy.mode = Mode::automatic;
  accuracy.strict = written.strict;
  check_exact(written, accuracy, on_reference);
  return accuracy;
}

std::optional<double> number_of(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

} // namespace pmdsim
