#pragma once
// Commands for a shell, where pipes and redirections matter.

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <sys/wait.h>

namespace pmdsim::test {

struct ShellRun {
  int exit_code;
  std::string output; // stdout
};

inline ShellRun run_in_shell(const std::string &command) {
  std::FILE *const program = ::popen(command.c_str(), "r");
  if (!program)
    throw std::runtime_error("no shell");
  std::string text;
  std::array<char, 4096> piece{};
  while (std::fgets(piece.data(), piece.size(), program))
    text += piece.data();
  const int status = ::pclose(program);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text};
}

} // namespace pmdsim::test
