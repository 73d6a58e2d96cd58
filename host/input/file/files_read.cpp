#include "host/input/file/files_read.h"

#include "host/input/file/content_hash.h"

#include <utility>

namespace pmdsim {
namespace {

thread_local FilesRead *noting = nullptr;

} // namespace

FilesRead::FilesRead(const std::filesystem::path &folder)
    : folder_(folder.empty() ? std::string() : (folder / "").string()), before_(std::exchange(noting, this)) {
}

FilesRead::~FilesRead() { noting = before_; }

void FilesRead::note(const std::filesystem::path &file, std::string_view bytes) {
  if (!noting)
    return;
  std::string path = file.string();
  if (path.starts_with(noting->folder_))
    path.erase(0, noting->folder_.size());
  FileRead read{std::move(path), bytes.size(), content_hash(bytes)};
  if (noting->known_.insert(read).second)
    noting->files_.push_back(std::move(read));
}

} // namespace pmdsim
