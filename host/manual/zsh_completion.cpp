#include "host/manual/manual.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

// `text` with a backslash before each of `special`, for a word in single quotes.
std::string escaped(const std::string &text, std::string_view special) {
  std::string out;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos)
      out += '\\';
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return out;
}

std::string zsh_value(const ArgumentRow &row) {
  if (offered(row).empty())
    return ":_files";
  return row.is_list ? fmt::format(":_values -s , value {}", fmt::join(offered(row), " "))
                     : fmt::format(":({})", fmt::join(offered(row), " "));
}

// A specification of _arguments for each of the option's names.
std::string specifications(const ArgumentRow &row) {
  std::string text;
  for (const std::string &name : row.names) {
    const bool is_long = name.starts_with("--");
    text += fmt::format(" \\\n      '({}){}{}[{}]", fmt::join(row.names, " "), name,
                        row.value.empty() ? ""
                        : is_long         ? "="
                                          : "+",
                        escaped(row.about, "[]:\\"));
    text += row.value.empty() ? "'" : fmt::format(":{}{}'", row.value, zsh_value(row));
  }
  return text;
}

std::string arguments_of(const CommandRow &command) {
  std::string text = fmt::format("    ({})\n      _arguments", command.name);
  for (const ArgumentRow &row : command.options)
    text += specifications(row);
  for (const ArgumentRow &row : command.operands)
    text +=
        fmt::format(" \\\n      '{}:{}{}'", row.is_repeated ? "*" : "", row.names.front(), zsh_value(row));
  return text + "\n      ;;\n";
}

} // namespace

std::string zsh_completion(const CommandTable &table) {
  std::string script = "#compdef pmdsim\n"
                       "# Completion of pmdsim's command line for zsh, made from the program's own tables.\n"
                       "local context state state_descr line\n"
                       "local -a commands\n"
                       "typeset -A opt_args\n"
                       "_arguments -C";
  for (const ArgumentRow &row : table.options)
    script += specifications(row);
  script += " \\\n      '1: :->command' '*:: :->argument'\n"
            "case $state in\n"
            "(command)\n"
            "  commands=(\n";
  for (const CommandRow &command : table.commands)
    script += fmt::format("    '{}:{}'\n", command.name, escaped(command.about, ":\\"));
  script += "  )\n"
            "  _describe command commands\n"
            "  ;;\n"
            "(argument)\n"
            "  case $line[1] in\n";
  for (const CommandRow &command : table.commands)
    script += arguments_of(command);
  return script + "  esac\n  ;;\nesac\n";
}

} // namespace pmdsim
