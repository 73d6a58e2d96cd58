#pragma once
// The command line of reports: of `pmdsim report` and of --report, which makes one when a run ends.

#include "host/output/page/report_page.h"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pmdsim {

// As it is written.
struct WrittenReporting {
  std::filesystem::path directory, file;
  std::optional<std::string> max_size;
  bool when_done = false; // --report
};

void add_report(CLI::App &command, WrittenReporting &written);
void add_report_flag(CLI::App &command, WrittenReporting &written);

// `frames` as --frames has them. Throws Error (usage).
ReportRequest report_request_of(const WrittenReporting &written, const std::optional<FrameRange> &frames);

} // namespace pmdsim
