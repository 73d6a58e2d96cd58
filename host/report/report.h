#pragma once
// The text that commands print on stdout.

#include "engine/model/accuracy.h"
#include "engine/model/error.h"
#include "engine/model/measurement.h"
#include "engine/model/sensor.h"
#include "engine/model/warning.h"

#include <optional>
#include <span>
#include <string>

namespace pmdsim {

// The program's exit code where nobody reads stdout any more, as a shell has it for SIGPIPE; nothing is said
// then.
inline constexpr ExitCode nobody_reads{141};

// Prints the text as it is, at once. Throws Error where stdout cannot take it: output or nobody_reads.
void print(const std::string &text);

// One line on stderr, "pmdsim: warning: PLACE: TEXT [CODE]", once in a process.
void warn(const Warning &warning);

// One line on stderr, "pmdsim: TEXT". That nobody reads it is no error.
void tell(const std::string &text);

// A sensor as a warning's place, "sensor NAME".
std::string place_of(const Sensor &sensor);

// "20 MHz".
std::string frequency_text(double modulation_hz);

// A number for a table, six significant digits; "-" for NaN.
std::string table_number(double value);

// "12.3 µm", four significant digits.
std::string micrometres_text(double length_m);

// "auto, fp32, 15 diodes summed".
std::string sum_text(Mode mode, const AccuracyReport &report);
// "at most 4 µm claimed, at most 1 µm found in 1024 pixels, checked in 2.000 ms"; empty where nothing is
// known.
std::string errors_text(const AccuracyReport &report);
// Where pixels of the sensor's frame may be off by more than was asked for; nothing where there are none.
std::optional<Warning> unpromised_warning(const AccuracyReport &report, double max_error_m,
                                          const Sensor &sensor);
// "multipath error at most 0.8 mm in 95 % of the pixels, estimated, from 2504 elements and 100000 lines".
std::string bounces_text(const BouncesReport &report);
// A line of each of these texts, as far as they say something beyond mode exact in fp32.
std::string accuracy_text(Mode mode, const AccuracyReport &report);

// Over the values that are finite; NaN where there is none.
struct Spread {
  double min, median, max;
};
Spread spread_of(std::span<const float> values);
Spread spread_of(std::span<const double> values);

} // namespace pmdsim
