#pragma once
// The report of a run: one HTML page for any browser, which needs no network and nothing beside itself.

#include "host/output/run/frame_range.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr const char *report_name = "report.html";
// MiB that a page may have, about.
inline constexpr double default_report_mib = 10.0, least_report_mib = 1.0, most_report_mib = 1000.0;

struct ReportRequest {
  std::filesystem::path directory{};   // of the run
  std::filesystem::path file{};        // the page; empty: report.html in the directory
  std::optional<FrameRange> frames{};  // instead of all
  double max_mib = default_report_mib; // that the page may have, about
};

struct WrittenReport {
  std::string file;
  std::uint64_t bytes = 0;
  std::size_t frames = 0;            // of the sensor that has most
  std::vector<std::string> left_out; // a sentence each
};

// `check` is called now and then; what it throws comes out. Throws Error: (input) as read_run() and
// read_frame(); (output).
WrittenReport write_report(const ReportRequest &request, const std::function<void()> &check);

// report (the page), bytes, frames, left_out.
nlohmann::ordered_json report_json(const WrittenReport &report);

} // namespace pmdsim
