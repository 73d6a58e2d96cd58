#pragma once
// What all fuzz targets share: which errors may come out of a reader, and files for readers that take no
// bytes.

#include "engine/model/error.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

// Begins the function of a target: libFuzzer's entry where each is a fuzzer; where all are one program, which
// lists them, a function with the target's name.
#ifdef PMDSIM_FUZZ
#define FUZZ_TARGET(name)                                                                                    \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);                         \
  int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
#else
#define FUZZ_TARGET(name)                                                                                    \
  extern "C" int fuzz_##name(const std::uint8_t *data, std::size_t size);                                    \
  int fuzz_##name(const std::uint8_t *data, std::size_t size)
#endif

namespace pmdsim::fuzz {

inline std::string_view text_of(const std::uint8_t *data, std::size_t size) {
  return {reinterpret_cast<const char *>(data), size};
}

// Ends the process where a text that a person or a terminal shows is not what it has to be: UTF-8 in one
// line, without control characters (C0, DEL, C1).
void check_line(std::string_view text);

// Calls `read`, out of which only an Error of one of these codes may come, with a line that check_line()
// takes. Whatever else comes goes on to whoever runs the target, who takes it for a crash. Whether nothing
// came.
template <class Read>
bool accepts(const Read &read, std::initializer_list<ExitCode> codes = {ExitCode::input}) {
  try {
    read();
    return true;
  } catch (const Error &error) {
    check_line(error.what());
    check_line(error.where().file);
    check_line(error.where().place);
    for (const ExitCode code : codes)
      if (error.code() == code)
        return false;
    throw std::logic_error(std::string("an Error of another code: ") + error.what());
  }
}

// A folder of this process for the files of a target; gone when it ends.
const std::filesystem::path &folder();

// Makes or replaces a file of folder().
std::filesystem::path write_file(const std::string &name, std::string_view bytes);

} // namespace pmdsim::fuzz
