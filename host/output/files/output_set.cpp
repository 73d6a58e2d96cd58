#include "host/output/files/output_set.h"

#include "engine/model/error.h"

#include <algorithm>
#include <cerrno>
#include <fmt/format.h>
#include <iterator>
#include <ranges>
#include <system_error>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path &directory, const std::error_code &error) {
  throw Error(ExitCode::output,
              fmt::format("{}: output directory cannot be written: {}", directory.string(), error.message()));
}

std::vector<fs::path> missing_directories(const fs::path &directory) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path path = directory; !path.empty() && !fs::exists(path, ignored); path = path.parent_path())
    missing.insert(missing.begin(), path);
  return missing;
}

void remove_if_empty(const std::vector<fs::path> &directories) {
  std::error_code ignored;
  for (const fs::path &path : std::views::reverse(directories))
    fs::remove(path, ignored);
}

// A trailing slash would make parent_path() name the same directory again.
fs::path without_trailing_slash(const fs::path &path) {
  return path.has_filename() || !path.has_relative_path() ? path : path.parent_path();
}

std::unique_ptr<OutputFile> write_file(const fs::path &directory, const FileToWrite &file) {
  if (file.name.find('/') != std::string::npos)
    throw Error(ExitCode::output, fmt::format("{}: expected a file name without '/'", file.name));
  auto written = std::make_unique<OutputFile>(directory / file.name);
  file.write(*written);
  written->close();
  return written;
}

} // namespace

WrittenFiles write_files(const fs::path &directory, const std::vector<FileToWrite> &files) {
  WrittenFiles written(files.size());
  const auto write_one = [&](std::size_t i) { written[i] = write_file(directory, files[i]); };
  // Isolated: a thread that waits for the last of these files takes up no other frame's work meanwhile.
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, files.size(), write_one); });
  return written;
}

OutputSet::OutputSet(const fs::path &directory)
    : directory_(without_trailing_slash(directory)), created_(missing_directories(directory_)) {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (!error && ::access(directory_.c_str(), W_OK | X_OK) != 0)
    error = std::error_code(errno, std::generic_category());
  if (error) {
    remove_if_empty(created_);
    fail(directory_, error);
  }
}

OutputSet::~OutputSet() {
  if (published_)
    return;
  files_.clear();
  remove_if_empty(created_);
}

void OutputSet::add(const std::string &name, const std::function<void(OutputFile &)> &write) {
  files_.push_back(write_file(directory_, {name, write}));
}

void OutputSet::add(WrittenFiles files) { std::ranges::move(files, std::back_inserter(files_)); }

std::vector<std::string> OutputSet::paths() const {
  std::vector<std::string> paths;
  for (const auto &file : files_)
    paths.push_back(file->path().string());
  return paths;
}

void OutputSet::publish(const std::vector<std::string> &obsolete) {
  // A file that has replaced the user's cannot give it back: what can be foreseen must not come to that.
  for (const auto &file : files_)
    file->check_publishable();
  for (const std::string &name : obsolete)
    remove_file(directory_ / name);
  std::size_t renamed = 0;
  try {
    for (; renamed < files_.size(); ++renamed)
      files_[renamed]->publish();
  } catch (const Error &) {
    for (std::size_t i = 0; i < renamed; ++i)
      files_[i]->withdraw();
    throw;
  }
  published_ = true;
}

} // namespace pmdsim
