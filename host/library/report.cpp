// The page of a run that the program has written.

#include "host/library/calls.h"
#include "host/output/files/manifest.h"
#include "host/output/page/report_page.h"

#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::library;

pmdsim_status pmdsim_report(const char *directory, const char *file, double max_mib, const char **json) {
  return guarded([&] {
    required(json, "json");
    ReportRequest request{&required(directory, "directory")};
    request.file = file ? file : "";
    if (max_mib != 0.0)
      request.max_mib = max_mib;
    if (!(request.max_mib >= least_report_mib && request.max_mib <= most_report_mib))
      throw bad_argument(fmt::format("max_mib: expected {} to {}, or 0, found {}", least_report_mib,
                                     most_report_mib, max_mib));
    *json = keep_for_thread(json_text(report_json(write_report(request, [] {}))));
  });
}
