#include "host/manual/manual.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::string words(const std::vector<ArgumentRow> &rows) {
  std::vector<std::string> names;
  for (const ArgumentRow &row : rows)
    names.insert(names.end(), row.names.begin(), row.names.end());
  return fmt::format("{}", fmt::join(names, " "));
}

// Values of a command's operands.
std::string operand_values(const CommandRow &command) {
  std::vector<std::string> values;
  for (const ArgumentRow &row : command.operands)
    values.insert(values.end(), offered(row).begin(), offered(row).end());
  return fmt::format("{}", fmt::join(values, " "));
}

std::string command_names(const CommandTable &table, const char *separator) {
  std::vector<std::string> names;
  for (const CommandRow &command : table.commands)
    names.push_back(command.name);
  return fmt::format("{}", fmt::join(names, separator));
}

// The case of an option's value: "'render --format') choices='exr npy' is_list=1 ;;".
std::string value_case(const CommandRow &command, const ArgumentRow &row) {
  std::vector<std::string> patterns;
  for (const std::string &name : row.names)
    patterns.push_back(fmt::format("'{} {}'", command.name, name));
  const std::string action =
      offered(row).empty()
          ? std::string("is_file=1")
          : fmt::format("choices='{}' is_list={}", fmt::join(offered(row), " "), row.is_list ? 1 : 0);
  return fmt::format("  {}) {} ;;\n", fmt::join(patterns, "|"), action);
}

constexpr std::string_view beginning =
    R"(# Completion of pmdsim's command line for bash, made from the program's own tables.
_pmdsim() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local command= options= operands= choices= is_list=0 is_file=0 before= i
  COMPREPLY=()
  # Of --option=value bash makes three words.
  if [ "$current" = '=' ]; then
    current=
  elif [ "$previous" = '=' ]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    case ${COMP_WORDS[i]} in
)";

constexpr std::string_view ending = R"(  if [ "$is_list" = 1 ] && [[ $current == *,* ]]; then
    before=${current%,*},
  fi
  if [ -n "$choices" ]; then
    COMPREPLY=($(compgen -P "$before" -W "$choices" -- "${current##*,}"))
  elif [ "$is_file" = 0 ] && [[ -z $command || $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    [ "$is_file" = 0 ] && COMPREPLY=($(compgen -W "$operands" -- "$current"))
    compopt -o default 2>/dev/null # files; there are no options to set where no completion is going on
  fi
}
complete -F _pmdsim pmdsim
)";

} // namespace

std::string bash_completion(const CommandTable &table) {
  std::string script(beginning);
  script += fmt::format("    {}) command=${{COMP_WORDS[i]}}; break ;;\n    esac\n  done\n",
                        command_names(table, "|"));
  script += "  case $command in\n";
  for (const CommandRow &command : table.commands)
    script += fmt::format("  {}) options='{}' operands='{}' ;;\n", command.name, words(command.options),
                          operand_values(command));
  script += fmt::format("  *) options='{} {}' ;;\n  esac\n", command_names(table, " "), words(table.options));
  script += "  case \"$command $previous\" in\n";
  for (const CommandRow &command : table.commands)
    for (const ArgumentRow &row : command.options)
      if (!row.value.empty())
        script += value_case(command, row);
  script += "  esac\n";
  return script.append(ending);
}

} // namespace pmdsim
