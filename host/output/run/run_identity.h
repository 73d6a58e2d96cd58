#pragma once
// What makes two runs the same: whatever decides what their frames hold. Of which frames there are, where
// they are written, on which machine and when, it says nothing.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pmdsim {

inline constexpr const char *run_file_name = "run.json";
inline constexpr const char *manifest_name = "manifest.json";

struct RunIdentity {
  nlohmann::ordered_json head; // head_json()
  std::string hash;            // of it

  bool operator==(const RunIdentity &) const = default;
};

// The process that has begun a run, for messages.
struct Beginner {
  std::string host;
  int process = 0;
};
Beginner this_process();

// The head, the hash and who has begun: what run.json holds.
std::string run_file_text(const RunIdentity &run, const Beginner &beginner);

struct RunFile {
  RunIdentity run;
  Beginner beginner;
};
// Nothing where the text is not that of such a file.
std::optional<RunFile> parsed_run_file(const std::string &text);
// Of a folder. Throws Error (input) where it has none.
RunFile read_run_file(const std::filesystem::path &folder);

// The first thing in which `there` differs from `here`, for people: "the setup differs at /sensors/0/samples:
// 1 there, 2 here".
std::string difference_text(const RunIdentity &there, const RunIdentity &here);

} // namespace pmdsim
