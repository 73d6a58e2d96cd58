#include "host/report/report.h"
#include "host/capture/progress.h"
#include "host/commands/commands.h"
#include "host/commands/report_of_run.h"
#include "host/output/page/report_page.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::string report_text(const WrittenReport &report) {
  std::string text = fmt::format("{} frame{}, {:.1f} MiB\n", report.frames, report.frames == 1 ? "" : "s",
                                 static_cast<double>(report.bytes) / (1024.0 * 1024.0));
  for (const std::string &sentence : report.left_out)
    text += sentence + '\n';
  return text + fmt::format("\nwritten:\n  {}\n", report.file);
}

} // namespace

void run_report(const Options &options) {
  const WrittenReport report = write_report(*options.report, throw_if_interrupted);
  if (options.json)
    print(json_text(report_json(report)));
  else
    print(report_text(report));
}

std::string report_of_run(const Options &options, const Capture &capture) {
  if (!options.report || capture.frame_count() == 0)
    return {};
  ReportRequest request = *options.report;
  request.directory = capture.sequence().path();
  return write_report(request, throw_if_interrupted).file;
}

std::string report_line(const std::string &report) {
  return report.empty() ? "" : fmt::format("\nreport:\n  {}\n", report);
}

} // namespace pmdsim
