#include "host/command_line/usage.h"

#include "engine/model/error.h"
#include "host/input/words/near_name.h"
#include "host/input/words/quotes.h"
#include "host/input/words/utf8.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <optional>

namespace pmdsim {
namespace {

using Names = std::vector<std::string>;

// "--samples" of "--samples=4".
std::string option_name(const std::string &argument) { return argument.substr(0, argument.find('=')); }

bool is_option(const std::string &argument) { return argument.size() > 1 && argument.front() == '-'; }

// With their dashes.
Names options_of(const CLI::App &command) {
  Names names;
  for (const CLI::Option *option : command.get_options())
    for (const std::string &name : option->get_lnames())
      names.push_back("--" + name);
  return names;
}

const CLI::Option *operand_of(const CLI::App &command) {
  for (const CLI::Option *option : command.get_options())
    if (option->get_positional())
      return option;
  return nullptr;
}

std::vector<const CLI::App *> commands_of(const CLI::App &app) {
  return app.get_subcommands([](const CLI::App *command) { return !command->get_group().empty(); });
}

Names command_names(const CLI::App &app) {
  Names names;
  for (const CLI::App *command : commands_of(app))
    names.push_back(command->get_name());
  return names;
}

bool has_option(const CLI::App &command, const std::string &name) {
  const Names names = options_of(command);
  return std::ranges::find(names, name) != names.end();
}

Names commands_with(const CLI::App &app, const std::string &option) {
  Names names;
  for (const CLI::App *command : commands_of(app))
    if (has_option(*command, option))
      names.push_back(command->get_name());
  return names;
}

// A dash that a text program has made of two.
bool has_long_dash(const std::string &argument) {
  return argument.starts_with("\xe2\x80\x93") || argument.starts_with("\xe2\x80\x94") ||
         argument.starts_with("\xe2\x88\x92");
}

bool is_setup_like(const std::string &argument) {
  std::error_code ignored;
  return argument.ends_with(".json") || std::filesystem::is_regular_file(argument, ignored);
}

std::string without_command(const CLI::App &app) {
  const Names commands = command_names(app);
  if (app.remaining().empty())
    return "expected a command: " + listed_names(commands);
  const std::string first = app.remaining().front(), option = option_name(first);
  if (is_option(first)) {
    const Names with = commands_with(app, option);
    if (!with.empty())
      return fmt::format("{}: expected the command first, as in pmdsim {} {}", option, with.front(), option);
    return fmt::format("unknown option {}{}", option, did_you_mean(option, options_of(app)));
  }
  const std::string meant = did_you_mean(first, commands);
  if (meant.empty() && is_setup_like(first))
    return fmt::format("expected a command before {}, as in pmdsim check {}", in_quotes(first), first);
  return fmt::format("unknown command {}{}", in_quotes(first),
                     meant.empty() ? "; expected " + listed_names(commands) : meant);
}

// What helps whoever looks for an option where it is not, as the end of a message; empty where nothing is
// known.
std::string option_hint(const CLI::App &command, const std::string &option) {
  if (option.starts_with("--tolerance") && has_option(command, "--position"))
    return "; tolerances are --position 0.1mm, --axis 1deg, --intensity 5%, --phase 1deg and --dead 1%";
  if (option == "--variants" && has_option(command, "--set"))
    return fmt::format("; run {} once for each, with --set PATH=VALUE", command.get_name());
  return "";
}

std::string unexpected(const CLI::App &app, const CLI::App &command, const std::string &argument) {
  const std::string &name = command.get_name(), option = option_name(argument);
  if (!is_option(argument)) {
    const CLI::Option *operand = operand_of(command);
    return operand ? fmt::format("{}: expected one {}, found {} too", name, operand->get_name(true, true),
                                 in_quotes(argument))
                   : fmt::format("{}: expected options alone, found {}", name, in_quotes(argument));
  }
  if (has_option(command, option)) // before the command, where it is none of the program's
    return fmt::format("{}: expected the command first, as in pmdsim {} {}", option, name, option);
  const Names with = commands_with(app, option);
  if (!with.empty())
    return fmt::format("{} has no option {}, which belongs to {}{}", name, option, fmt::join(with, ", "),
                       option_hint(command, option));
  if (const std::string hint = option_hint(command, option); !hint.empty())
    return fmt::format("{} has no option {}{}", name, option, hint);
  const auto meant = nearest_name(option, options_of(command));
  return meant ? fmt::format("{} has no option {}, did you mean {}?", name, option, *meant)
               : fmt::format("{} has no option {}", name, option);
}

// "--mode: fast not in {exact,reduced,auto}", as CLI11 says it. Here and below std::regex would recurse over
// a long value until the stack ends.
std::string wrong_choice(const std::string &text) {
  constexpr std::string_view before_value = ": ", before_choices = " not in {";
  const std::size_t option_end = text.find(before_value), value_end = text.rfind(before_choices);
  if (!text.starts_with("--") || !text.ends_with('}') || option_end == text.npos || value_end == text.npos ||
      value_end < option_end + before_value.size())
    return text;
  const std::size_t value_begin = option_end + before_value.size();
  const std::string option = text.substr(0, option_end),
                    value = text.substr(value_begin, value_end - value_begin);
  Names choices;
  std::string rest = text.substr(value_end + before_choices.size());
  rest.pop_back();
  for (std::size_t end = 0; end != std::string::npos; rest.erase(0, end + 1)) {
    end = rest.find(',');
    choices.push_back(rest.substr(0, end));
    if (end == std::string::npos)
      break;
  }
  return fmt::format("{}: expected {}, found {}{}", option, fmt::join(choices, ", "), in_quotes(value),
                     did_you_mean(value, choices));
}

// What is missing: an operand, or the value behind an option.
std::string missing(const CLI::App &command, const std::string &text, const Names &arguments) {
  const CLI::Option *operand = operand_of(command);
  if (operand && text.starts_with(operand->get_name(true, true)))
    return fmt::format("{}: expected {}, {}, found none", command.get_name(), operand->get_name(true, true),
                       operand->get_description());
  for (const std::string &argument : arguments)
    if (is_option(argument) && text.find(option_name(argument)) != std::string::npos)
      return fmt::format("{}: expected a value behind it, found none", option_name(argument));
  return text;
}

// "Could not convert: --triangles = many", as CLI11 says it.
std::string wrong_number(const std::string &text) {
  constexpr std::string_view before_option = "Could not convert: ", before_value = " = ";
  const std::size_t option_end = text.find(before_value);
  if (!text.starts_with(before_option) || option_end == text.npos)
    return text;
  return fmt::format("{}: expected a number, found {}",
                     text.substr(before_option.size(), option_end - before_option.size()),
                     in_quotes(text.substr(option_end + before_value.size())));
}

// A flag that was given a value.
std::optional<std::string> flag_with_value(const CLI::App &command, const Names &arguments) {
  for (const std::string &argument : arguments)
    if (const std::string name = option_name(argument); name != argument && has_option(command, name))
      if (command.get_option(name)->get_expected_max() == 0)
        return fmt::format("{}: expected no value, found {}{}", name,
                           in_quotes(argument.substr(name.size() + 1)),
                           name == "--json" ? "; it prints on stdout, which > puts into a file" : "");
  return std::nullopt;
}

// The last where there are more than the command takes.
std::optional<std::string> one_operand_too_many(const CLI::App &command, const CLI::ParseError &error) {
  const CLI::Option *operand = operand_of(command);
  if (!operand || !dynamic_cast<const CLI::ArgumentMismatch *>(&error) ||
      operand->count() <= static_cast<std::size_t>(operand->get_expected_max()))
    return std::nullopt;
  return operand->results().back();
}

std::string problem_of(const CLI::App &app, const CLI::ParseError &error, const Names &arguments) {
  std::string text = error.what();
  text.erase(text.find_last_not_of('\n') + 1);
  std::ranges::replace(text, '\n', ' ');
  if (app.get_subcommands().empty())
    return without_command(app);
  const CLI::App &command = *app.get_subcommands().front();
  if (const auto flag = flag_with_value(command, arguments))
    return *flag;
  const Names extras = app.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError *>(&error) && !extras.empty())
    return unexpected(app, command, extras.front());
  if (const auto more = one_operand_too_many(command, error); more)
    return unexpected(app, command, extras.empty() ? *more : extras.front());
  if (dynamic_cast<const CLI::ConversionError *>(&error))
    return wrong_number(text);
  if (dynamic_cast<const CLI::ValidationError *>(&error))
    return wrong_choice(text);
  if (dynamic_cast<const CLI::RequiredError *>(&error) || dynamic_cast<const CLI::ArgumentMismatch *>(&error))
    return missing(command, text, arguments);
  return text;
}

} // namespace

void refuse_misread(const CLI::App &app, const Names &arguments) {
  for (const std::string &argument : arguments) {
    if (has_long_dash(argument))
      throw Error(ExitCode::usage,
                  fmt::format("expected two short dashes before an option, found {}", in_one_line(argument)));
    const std::string doubled = "-" + option_name(argument);
    if (argument.size() > 2 && argument.front() == '-' && argument[1] != '-' &&
        !commands_with(app, doubled).empty())
      throw Error(ExitCode::usage, in_one_line(fmt::format("unknown option {}, did you mean {}?",
                                                           option_name(argument), doubled)));
  }
}

std::string usage_problem(const CLI::App &app, const CLI::ParseError &error, const Names &arguments) {
  const std::string command =
      app.get_subcommands().empty() ? "" : app.get_subcommands().front()->get_name() + " ";
  return in_one_line(fmt::format("{} (see pmdsim {}--help)", problem_of(app, error, arguments), command));
}

} // namespace pmdsim
