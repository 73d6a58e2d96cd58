#include "host/input/file/input_file.h"

#include "host/input/file/files_read.h"
#include "host/input/file/memory_request.h"
#include "host/input/words/file_kind.h"
#include "host/input/words/near_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fcntl.h>
#include <fmt/format.h>
#include <memory>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <variant>

namespace pmdsim {
namespace {

constexpr std::size_t max_text_bytes = std::size_t{1} << 26;

std::string reason(int error, const std::filesystem::path &file) {
  return error == ENOENT ? "no such file" + absent_file_hint(file)
                         : fmt::format("cannot be read ({})", std::generic_category().message(error));
}

Error refused(const std::filesystem::path &file, const std::string &why, const AnyPlace &named_at) {
  const auto &named_in = std::visit(
      [](const auto &place) -> const auto & { return place.file; }, named_at);
  return input_error(named_at, named_in == file ? why : in_quotes(file.string()) + ": " + why);
}

struct Close {
  void operator()(std::FILE *stream) const { std::fclose(stream); }
};

using Stream = std::unique_ptr<std::FILE, Close>;

Stream opened(const std::filesystem::path &file, const AnyPlace &named_at) {
  if (file.native().find('\0') != std::string::npos) // the system takes it for the end of a name
    throw refused(file, "expected a file's name without NUL", named_at);
  // Without O_NONBLOCK, opening a FIFO waits for a writer.
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  Stream stream(descriptor < 0 ? nullptr : fdopen(descriptor, "rb"));
  if (!stream) {
    const int error = errno;
    if (descriptor >= 0)
      close(descriptor);
    throw refused(file, reason(error, file), named_at);
  }
  return stream;
}

std::size_t size_of_regular(const Stream &stream, const std::filesystem::path &file,
                            const AnyPlace &named_at) {
  struct stat status {};
  if (fstat(fileno(stream.get()), &status) != 0)
    throw refused(file, reason(errno, file), named_at);
  if (S_ISDIR(status.st_mode))
    throw refused(file, "is a directory, expected a file", named_at);
  if (!S_ISREG(status.st_mode))
    throw refused(file, "is no regular file", named_at);
  return static_cast<std::size_t>(status.st_size);
}

std::string front_of(const Stream &stream, std::size_t length_bytes, const std::filesystem::path &file,
                     const AnyPlace &named_at) {
  std::string bytes(length_bytes, '\0');
  if (std::fread(bytes.data(), 1, length_bytes, stream.get()) != length_bytes)
    throw refused(file, std::ferror(stream.get()) ? reason(errno, file) : "became shorter while it was read",
                  named_at);
  FilesRead::note(file, bytes);
  return bytes;
}

} // namespace

std::string read_regular_file(const std::filesystem::path &file, std::size_t max_bytes,
                              const AnyPlace &named_at) {
  const Stream stream = opened(file, named_at);
  const std::size_t size_bytes = size_of_regular(stream, file, named_at);
  if (size_bytes > max_bytes)
    throw refused(file, fmt::format("has {} bytes, expected at most {}", size_bytes, max_bytes), named_at);
  require_memory(size_bytes, named_at, file.filename().string());
  return front_of(stream, size_bytes, file, named_at);
}

std::string read_front_of_regular_file(const std::filesystem::path &file, std::size_t length_bytes,
                                       const Place &named_at) {
  const Stream stream = opened(file, named_at);
  const std::size_t size_bytes = size_of_regular(stream, file, named_at);
  if (size_bytes < length_bytes)
    throw refused(file, fmt::format("has {} bytes, expected at least {}", size_bytes, length_bytes),
                  named_at);
  require_memory(length_bytes, named_at, file.filename().string());
  return front_of(stream, length_bytes, file, named_at);
}

std::string read_text_file(const std::filesystem::path &file, const AnyPlace &named_at) {
  std::string text = read_regular_file(file, max_text_bytes, named_at);
  if (const std::string kind = kind_of_file("", text); !kind.empty() && !kind.starts_with("an IES"))
    throw input_error(Place{file}, "is " + kind + ", expected text");
  const auto nul = std::ranges::find(text, '\0'); // readers would take it for the end of a field
  if (nul != text.end())
    throw input_error(TextPlace{file, static_cast<std::size_t>(std::count(text.begin(), nul, '\n')) + 1},
                      "expected text, found a NUL byte");
  return text;
}

double number_of(std::string_view text, std::string_view what, const TextPlace &place, NumberRange range) {
  double value = 0.0;
  const bool has_plus = text.starts_with('+') && !text.starts_with("+-"); // from_chars takes none
  const char *end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data() + (has_plus ? 1 : 0), end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value))
    throw input_error(place, fmt::format("{}: expected a number, found {}", what, in_quotes(text)));
  if (value < range.lowest || value > range.highest)
    throw input_error(place, fmt::format("{}: expected a number from {} to {}, found {}", what, range.lowest,
                                         range.highest, in_quotes(text)));
  return value;
}

} // namespace pmdsim
