// Short texts that options and tables have: lengths, numbers, paths of values, and names that are near
// others.

#include "tests/fuzz/target.h"

#include "host/command_line/setup_options.h"
#include "host/input/file/input_file.h"
#include "host/input/file/length.h"
#include "host/input/words/near_name.h"
#include "host/input/words/quotes.h"

using namespace pmdsim;

FUZZ_TARGET(words) {
  const std::string text(fuzz::text_of(data, size));
  if (const auto length = length_m(text);
      length && !(*length >= least_written_length_m && *length <= largest_written_length_m))
    throw std::logic_error("a length beyond its limits");
  fuzz::check_line(in_quotes(text));
  fuzz::check_line(did_you_mean(text, std::vector<std::string>{"sensors", "illuminators", "modulation_hz"}));
  fuzz::accepts([&] { number_of(text, "number", TextPlace{"table.csv", 1, 2}, {-1.0, 1e9}); });
  const std::size_t end = text.find('\n'); // two changes: before and behind a line break
  fuzz::accepts(
      [&] {
        changes_of({text.substr(0, end), end < size ? text.substr(end + 1) : "a=1"});
      },
      {ExitCode::usage, ExitCode::input});
  fuzz::accepts([&] { poses_of(text); }, {ExitCode::usage});
  return 0;
}
