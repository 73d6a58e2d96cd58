#include "host/output/files/output_set.h"

#include "engine/model/error.h"
#include "host/output/files/durable.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

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

void OutputSet::add(const std::string &name, const std::function<void(OutputFile &)> &write) {
  files_.push_back(write_file(directory(), {name, write}));
}

void OutputSet::add(WrittenFiles files) { std::ranges::move(files, std::back_inserter(files_)); }

std::vector<std::string> OutputSet::paths() const {
  std::vector<std::string> paths;
  for (const auto &file : files_)
    paths.push_back(file->path().string());
  return paths;
}

void OutputSet::publish() {
  sync_file_system(directory());
  give_names();
  sync_names(directory());
}

void OutputSet::give_names(const std::vector<std::string> &obsolete) {
  // A file that has replaced the user's cannot give it back: what can be foreseen must not come to that.
  for (const auto &file : files_)
    file->check_publishable();
  for (const std::string &name : obsolete)
    remove_file(directory() / name);
  std::size_t renamed = 0;
  try {
    for (; renamed < files_.size(); ++renamed)
      files_[renamed]->publish();
  } catch (const Error &) {
    for (std::size_t i = 0; i < renamed; ++i)
      files_[i]->withdraw();
    throw;
  }
  directory_.stay();
}

} // namespace pmdsim
