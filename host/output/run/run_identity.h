#pragma once
// What makes two runs the same: whatever decides what their frames hold. Of which frames there are, where
// they are written, on which machine and when, it says nothing.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace pmdsim {

inline constexpr const char *run_file_name = "run.json";
// The byte of it that every process locks which lives in the folder: shared, or alone there.
inline constexpr std::uint64_t living_byte = 0;
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
// Nothing where the text is not that of such a file. Of the head only `inputs` is looked at: where there are
// any, they name files.
// `file` is what messages name.
std::optional<RunFile> parsed_run_file(const std::string &text, const std::filesystem::path &file);
// Of a folder. Throws Error (input) where it has none, or one that is no regular file.
RunFile read_run_file(const std::filesystem::path &folder);

// The first thing in which `there` differs from `here`, for people: "the setup differs at /sensors/0/samples:
// 1 there, 2 here".
std::string difference_text(const RunIdentity &there, const RunIdentity &here);

} // namespace pmdsim
