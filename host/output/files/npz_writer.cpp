#include "host/output/files/channel.h"

#include "host/output/files/output_file.h"

#include <archive.h>
#include <archive_entry.h>
#include <cerrno>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <string_view>

namespace pmdsim {
namespace {

// A ZIP archive whose files are stored as they are.
class ZipFile {
public:
  explicit ZipFile(OutputFile &file) : file_(file), archive_(archive_write_new()) {
    check(archive_ ? archive_write_set_format_zip(archive_.get()) : ARCHIVE_FATAL);
    check(archive_write_zip_set_compression_store(archive_.get()));
    check(archive_write_set_bytes_per_block(archive_.get(), 0)); // what is written goes on as it is
    check(archive_write_open2(archive_.get(), this, nullptr, write, nullptr, nullptr));
  }
  ZipFile(const ZipFile &) = delete; // libarchive knows where it is
  ZipFile &operator=(const ZipFile &) = delete;

  void begin(const std::string &name, std::size_t bytes) {
    const std::unique_ptr<archive_entry, Free> entry(archive_entry_new());
    archive_entry_set_pathname(entry.get(), name.c_str());
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(bytes));
    check(archive_write_header(archive_.get(), entry.get())); // without a time: the same of all
  }
  void add(std::string_view bytes) {
    const la_ssize_t added = archive_write_data(archive_.get(), bytes.data(), bytes.size());
    check(added == static_cast<la_ssize_t>(bytes.size()) ? ARCHIVE_OK : ARCHIVE_FATAL);
  }
  // After the last file.
  void finish() { check(archive_write_close(archive_.get())); }

private:
  struct Free {
    void operator()(archive *of) const { archive_write_free(of); }
    void operator()(archive_entry *of) const { archive_entry_free(of); }
  };

  // No exception may pass through libarchive's C. It ends the archive even where it failed.
  static la_ssize_t write(archive *, void *self, const void *bytes, std::size_t count) {
    auto &zip = *static_cast<ZipFile *>(self);
    try {
      if (zip.failure_)
        return -1;
      zip.file_.write({static_cast<const char *>(bytes), count});
      return static_cast<la_ssize_t>(count);
    } catch (...) {
      zip.failure_ = std::current_exception();
      return -1;
    }
  }

  void check(int result) const {
    if (failure_)
      std::rethrow_exception(failure_);
    if (result == ARCHIVE_OK)
      return;
    const char *reason = archive_ ? archive_error_string(archive_.get()) : nullptr;
    const bool lacks_memory = !archive_ || archive_errno(archive_.get()) == ENOMEM;
    throw write_error(file_.path(), reason ? reason : "libarchive gives no reason",
                      lacks_memory ? Lacking::memory : Lacking::other);
  }

  OutputFile &file_;
  std::exception_ptr failure_;
  std::unique_ptr<archive, Free> archive_; // dies first
};

std::string_view bytes_of(const Channel &channel) {
  return std::visit(
      [](auto values) {
        return std::string_view(reinterpret_cast<const char *>(values.data()), values.size_bytes());
      },
      written_values(channel));
}

} // namespace

void write_npz(OutputFile &file, const ChannelSet &channels) {
  ZipFile zip(file);
  for (const Channel &channel : channels.channels) {
    const std::string header = npy_header(channel, channels.resolution);
    const std::string_view values = bytes_of(channel);
    zip.begin(channel.name() + ".npy", header.size() + values.size());
    zip.add(header);
    zip.add(values);
  }
  zip.finish();
}

} // namespace pmdsim
