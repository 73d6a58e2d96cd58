#include "host/command_line/report_options.h"

#include "engine/model/error.h"
#include "host/command_line/accuracy_options.h"
#include "host/input/file/input_error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace pmdsim {
void add_report(CLI::App &command, WrittenReporting &written) {
  command.add_option("DIR", written.directory, "directory that render or deform has written")->required();
  command.add_option("-o,--output", written.file, fmt::format("the page [DIR/{}]", report_name));
  command.add_option("--max-size", written.max_size,
                     fmt::format("MiB that the page may have, about, {} to {}; beyond it channels, "
                                 "frames and pixels are left out, and the page says so [{}]",
                                 least_report_mib, most_report_mib, default_report_mib));
}

void add_report_flag(CLI::App &command, WrittenReporting &written) {
  command.add_flag("--report", written.when_done,
                   fmt::format("write {}, a page for a browser, when all frames are there; see `pmdsim "
                               "report`",
                               report_name));
}

ReportRequest report_request_of(const WrittenReporting &written, const std::optional<FrameRange> &frames) {
  ReportRequest request{written.directory, written.file, frames};
  if (written.max_size) {
    const std::optional<double> mib = number_of(*written.max_size);
    if (!mib || !(*mib >= least_report_mib && *mib <= most_report_mib))
      throw Error(ExitCode::usage,
                  fmt::format("--max-size: expected a number of MiB from {} to {}, found {}",
                              least_report_mib, most_report_mib, in_quotes(*written.max_size)));
    request.max_mib = *mib;
  }
  return request;
}

} // namespace pmdsim
