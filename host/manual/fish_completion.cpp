#include "host/manual/manual.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::string quoted(const std::string &text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\')
      out += '\\';
    out += c;
  }
  return out + "'";
}

std::string fish_value(const ArgumentRow &row) {
  if (row.value.empty())
    return "";
  if (offered(row).empty())
    return " -r -F";
  const std::string choices = fmt::format("{}", fmt::join(offered(row), " "));
  return row.is_list ? fmt::format(" -x -a '(__fish_append , {})'", choices)
                     : fmt::format(" -x -a '{}'", choices);
}

std::string line_of(const std::string &condition, const ArgumentRow &row) {
  std::string line = fmt::format("complete -c pmdsim -n {}", quoted(condition));
  for (const std::string &name : row.names)
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  return line + fish_value(row) + " -d " + quoted(row.about) + "\n";
}

} // namespace

std::string fish_completion(const CommandTable &table) {
  const std::string none = "__fish_use_subcommand";
  std::string script =
      "# Completion of pmdsim's command line for fish, made from the program's own tables.\n";
  for (const ArgumentRow &row : table.options)
    script += line_of(none, row);
  for (const CommandRow &command : table.commands)
    script +=
        fmt::format("complete -c pmdsim -n {} -f -a {} -d {}\n", none, command.name, quoted(command.about));
  for (const CommandRow &command : table.commands) {
    const std::string seen = "__fish_seen_subcommand_from " + command.name;
    for (const ArgumentRow &row : command.options)
      script += line_of(seen, row);
    for (const ArgumentRow &row : command.operands)
      if (!offered(row).empty())
        script += fmt::format("complete -c pmdsim -n {} -a '{}' -d {}\n", quoted(seen),
                              fmt::join(offered(row), " "), quoted(row.names.front()));
  }
  return script;
}

} // namespace pmdsim
