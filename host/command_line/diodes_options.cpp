#include "host/command_line/diodes_options.h"

#include "host/input/file/input_error.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <numbers>

namespace pmdsim {
namespace {

struct ToleranceUnit {
  std::map<std::string_view, double> units; // in the unit of Tolerances
  double most;
  const char *expected;
};

constexpr double degree = std::numbers::pi / 180.0;
const ToleranceUnit lengths{{{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}},
                            1.0,
                            "a length from 0 to 1 m with its unit, m, mm or um, e.g. 0.1mm"};
const ToleranceUnit tilts{{{"deg", degree}, {"rad", 1.0}},
                          90.0 * degree,
                          "an angle from 0 to 90 degrees with its unit, deg or rad, e.g. 1deg"};
const ToleranceUnit phases{{{"deg", degree}, {"rad", 1.0}},
                           180.0 * degree,
                           "an angle from 0 to 180 degrees with its unit, deg or rad, e.g. 1deg"};
const ToleranceUnit shares{{{"%", 0.01}}, 1.0, "a share from 0% to 100% with its sign, e.g. 5%"};
const ToleranceUnit chances{{{"%", 0.01}}, 0.5, "a chance from 0% to 50% with its sign, e.g. 1%"};

double tolerance_of(const char *option, const std::string &text, const ToleranceUnit &quantity) {
  constexpr double rounding = 1.0 + 1e-12; // of 90 degrees in radians
  double number = 0.0;
  const char *const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  const auto unit = quantity.units.find(std::string_view(end, static_cast<std::size_t>(last - end)));
  if (error == std::errc() && unit != quantity.units.end() && number >= 0.0 &&
      number * unit->second <= quantity.most * rounding)
    return number * unit->second;
  throw Error(ExitCode::usage,
              fmt::format("{}: expected {}, found {}", option, quantity.expected, in_quotes(text)));
}

template <class Whole>
Whole whole_of(const char *option, const std::string &text, Whole least, Whole most) {
  Whole value = 0;
  const char *const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error == std::errc() && end == last && value >= least && value <= most)
    return value;
  throw Error(ExitCode::usage, fmt::format("{}: expected a whole number from {} to {}, found {}", option,
                                           least, most, in_quotes(text)));
}

} // namespace

void add_diodes(CLI::App &command, WrittenDiodes &written) {
  command.add_option("--position", written.position,
                     "tolerance of each diode's place along x, y and z, m, mm or um [0.1mm]");
  command.add_option("--axis", written.axis, "of its axis towards x and y, deg or rad [1deg]");
  command.add_option("--intensity", written.intensity, "of its intensity [5%]");
  command.add_option("--phase", written.phase, "of its modulation's phase, deg or rad [1deg]");
  command.add_option("--dead", written.dead, "chance that it is dead [1%]");
  command
      .add_option("--law", written.law,
                  "how errors are distributed: gaussian, the tolerance is the standard deviation; uniform, "
                  "within plus and minus the tolerance [gaussian]")
      ->check(CLI::IsMember({"gaussian", "uniform"}));
  command.add_option("--boards", written.boards, "random boards, 100 to 100000 [4000]");
  command.add_option("--seed", written.seed, "of these, a whole number; the same gives the same boards [0]");
  command.add_option(
      "--pixels", written.pixels,
      "at most so many columns and rows, spread over the image, are looked at, 1 to 1024 [64]");
  command.add_option("--sensor", written.sensor, "name of the sensor [the first]");
}

DiodeRequest diode_request(const WrittenDiodes &written) {
  DiodeRequest request;
  Tolerances &tolerances = request.tolerances;
  const auto take = [](const char *option, const std::optional<std::string> &text,
                       const ToleranceUnit &quantity, double &value) {
    if (text)
      value = tolerance_of(option, *text, quantity);
  };
  take("--position", written.position, lengths, tolerances.position_m);
  take("--axis", written.axis, tilts, tolerances.axis_rad);
  take("--intensity", written.intensity, shares, tolerances.intensity);
  take("--phase", written.phase, phases, tolerances.phase_rad);
  take("--dead", written.dead, chances, tolerances.dead);
  if (written.law == "uniform")
    tolerances.law = ErrorLaw::uniform;
  if (written.boards)
    request.boards = whole_of<std::uint32_t>("--boards", *written.boards, 100, 100'000);
  if (written.seed)
    request.seed = whole_of<std::uint64_t>("--seed", *written.seed, 0, UINT64_MAX);
  if (written.pixels)
    request.pixels = whole_of<std::uint32_t>("--pixels", *written.pixels, 1, 1024);
  request.sensor = written.sensor;
  return request;
}

} // namespace pmdsim
