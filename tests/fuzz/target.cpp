#include "tests/fuzz/target.h"

#include "host/hdf5/hdf5.h"
#include "tests/support/temporary_folder.h"

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace pmdsim::fuzz {
namespace {

// As in the program.
[[maybe_unused]] const bool leaves_hdf5_open = (leave_hdf5_open_at_exit(), true);

// Why a text may not be shown; nullptr where it may.
const char *fault_of(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 || byte == 0x7f)
      return "a control character";
    if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0)
      return "a control character beyond ASCII";
  }
  try {
    static_cast<void>(nlohmann::json(std::string(text)).dump()); // takes UTF-8 alone
    return nullptr;
  } catch (const nlohmann::json::exception &) {
    return "bytes that are not UTF-8";
  }
}

} // namespace

void check_line(std::string_view text) {
  const char *fault = fault_of(text);
  if (fault == nullptr)
    return;
  std::fprintf(stderr, "%s in the line: %.*s\n", fault, static_cast<int>(text.size()), text.data());
  std::abort();
}

const std::filesystem::path &folder() {
  static const test::TemporaryFolder folder;
  return folder.path();
}

std::filesystem::path write_file(const std::string &name, std::string_view bytes) {
  std::filesystem::path file = folder() / name;
  std::FILE *stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr ||
      (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), stream) != bytes.size()) ||
      std::fclose(stream) != 0)
    throw std::runtime_error("cannot write " + file.string());
  return file;
}

} // namespace pmdsim::fuzz
