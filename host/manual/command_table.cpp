#include "host/manual/command_table.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace pmdsim {
namespace {

// What stands between braces in "TEXT:{exr,npy}", as CLI11 writes the type of a value that must be one of a
// set.
std::vector<std::string> choices_in(const std::string &type) {
  const std::size_t open = type.find('{');
  const std::size_t close = type.find('}');
  if (open == std::string::npos || close == std::string::npos)
    return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string value_kind(const CLI::Option &option) {
  if (option.get_items_expected_max() == 0)
    return "";
  const std::string type = option.get_type_name();
  const bool is_number = type.starts_with("UINT") || type.starts_with("INT") || type.starts_with("FLOAT");
  return is_number ? "number" : "text";
}

ArgumentRow row_of(const CLI::Option &option) {
  ArgumentRow row;
  if (option.get_positional())
    row.names = {option.get_name(true)};
  for (const std::string &name : option.get_snames())
    row.names.push_back("-" + name);
  for (const std::string &name : option.get_lnames())
    row.names.push_back("--" + name);
  row.value = value_kind(option);
  row.choices = choices_in(option.get_type_name());
  row.is_list = option.get_delimiter() != '\0';
  row.is_repeated = option.get_positional() && option.get_items_expected_max() > 1;
  row.is_required = option.get_required();
  row.about = option.get_description();
  return row;
}

std::vector<ArgumentRow> rows_of(const CLI::App &app, bool positional) {
  std::vector<ArgumentRow> rows;
  for (const CLI::Option *option : app.get_options())
    if (!option->get_group().empty() && option->get_positional() == positional)
      rows.push_back(row_of(*option));
  return rows;
}

} // namespace

CommandTable table_of(const CLI::App &app) {
  CommandTable table{.program = app.get_name(),
                     .about = app.get_description(),
                     .options = rows_of(app, false),
                     .commands = {}};
  for (const CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
    if (!command->get_group().empty())
      table.commands.push_back({.name = command->get_name(),
                                .about = command->get_description(),
                                .operands = rows_of(*command, true),
                                .options = rows_of(*command, false),
                                .footer = command->get_footer()});
  return table;
}

void suggest(CommandTable &table, const std::string &argument, const std::vector<std::string> &values) {
  for (CommandRow &command : table.commands)
    for (std::vector<ArgumentRow> *rows : {&command.operands, &command.options})
      for (ArgumentRow &row : *rows)
        if (std::ranges::find(row.names, argument) != row.names.end())
          row.suggestions = values;
}

const CommandRow *find_command(const CommandTable &table, const std::string &name) {
  const auto found = std::ranges::find(table.commands, name, &CommandRow::name);
  return found == table.commands.end() ? nullptr : &*found;
}

} // namespace pmdsim
