// The program's arguments, separated by NUL.

#include "tests/fuzz/target.h"

#include "host/command_line/options.h"

#include <cstdio>
#include <vector>

using namespace pmdsim;

namespace {

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words{"pmdsim"};
  for (std::size_t end = 0; !text.empty(); text.remove_prefix(std::min(end + 1, text.size()))) {
    end = std::min(text.find('\0'), text.size());
    words.emplace_back(text.substr(0, end));
  }
  return words;
}

} // namespace

FUZZ_TARGET(command_line) {
  const std::vector<std::string> words = words_of(fuzz::text_of(data, size));
  if (words.size() < 2)
    return 0; // prints the first steps
  std::vector<const char *> arguments;
  for (const std::string &word : words)
    arguments.push_back(word.c_str());
  fuzz::accepts([&] { parse_options(static_cast<int>(arguments.size()), arguments.data()); },
                {ExitCode::usage, ExitCode::input});
  return 0;
}
