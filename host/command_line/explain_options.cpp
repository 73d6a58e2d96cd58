#include "host/command_line/explain_options.h"

#include <CLI/CLI.hpp>

namespace pmdsim {

void add_explain(CLI::App &command, ExplainRequest &request) {
  CLI::Option *words = command.add_option(
      "KEY", request.words,
      "a key of a setup (taps, sensors/0/taps), a channel (multipath_m), a warning's code, or an exit code "
      "(exit 8) [all, a line each]");
  command
      .add_flag("--markdown", request.markdown, "print all as a page in Markdown, which is docs/reference.md")
      ->excludes(words);
}

} // namespace pmdsim
