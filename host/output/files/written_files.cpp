#include "host/output/files/written_files.h"

#include "engine/model/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace pmdsim {

std::unique_ptr<OutputFile> write_file(const std::filesystem::path &directory, const FileToWrite &file) {
  if (file.name.find('/') != std::string::npos)
    throw Error(ExitCode::output, fmt::format("{}: expected a file name without '/'", file.name));
  auto written = std::make_unique<OutputFile>(directory / file.name);
  file.write(*written);
  written->close();
  return written;
}

WrittenFiles write_files(const std::filesystem::path &directory, const std::vector<FileToWrite> &files) {
  WrittenFiles written(files.size());
  const auto write_one = [&](std::size_t i) { written[i] = write_file(directory, files[i]); };
  // Isolated: a thread that waits for the last of these files takes up no other frame's work meanwhile.
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, files.size(), write_one); });
  return written;
}

} // namespace pmdsim
