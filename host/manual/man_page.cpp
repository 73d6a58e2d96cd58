#include "host/manual/manual.h"

#include "host/manual/exit_codes.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>
#include <string_view>

namespace pmdsim {
namespace {

constexpr std::string_view environment = R"(.SH ENVIRONMENT
.TP
.B LP_NATIVE_VECTOR_WIDTH
the width of the vectors of Mesa's lavapipe, in bits; more than 256 become 256
.TP
.B MESA_SHADER_CACHE_DIR
where Mesa keeps compiled shaders; by default below
.BR XDG_CACHE_HOME " or " ~/.cache
)";

// The code point that begins at text[i], which is moved behind it.
std::uint32_t next_code_point(std::string_view text, std::size_t &i) {
  const auto first = static_cast<unsigned char>(text[i++]);
  if (first < 0x80)
    return first;
  int following = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  std::uint32_t code = first & (0x3fU >> following);
  for (; following > 0 && i < text.size(); --following)
    code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3fU);
  return code;
}

std::string roff_of(std::uint32_t code) {
  switch (code) {
  case '\\':
    return "\\e";
  case '-':
    return "\\-";
  case '~':
    return "\\(ti";
  case '^':
    return "\\(ha";
  case '"':
    return "\\(dq";
  default:
    return code < 0x80 ? std::string(1, static_cast<char>(code)) : fmt::format("\\[u{:04X}]", code);
  }
}

// Text as roff; what stands between backquotes is bold.
std::string roff(std::string_view text) {
  std::string out;
  bool is_bold = false;
  if (text.starts_with('.') || text.starts_with('\''))
    out = "\\&";
  for (std::size_t i = 0; i < text.size();) {
    const std::uint32_t code = next_code_point(text, i);
    if (code == '`')
      out += (is_bold = !is_bold) ? "\\fB" : "\\fR";
    else
      out += roff_of(code);
  }
  return out + (is_bold ? "\\fR" : "");
}

std::string bold(std::string_view text) { return fmt::format("\\fB{}\\fR", roff(text)); }
std::string italic(std::string_view text) { return fmt::format("\\fI{}\\fR", roff(text)); }

std::string head(const std::string &name, const std::string &version, std::string_view about) {
  return fmt::format(".\\\" Made from the program's own tables.\n.TH {} 1 \"\" \"pmdsim {}\" \"pmdsim\"\n"
                     ".SH NAME\n{} \\- {}\n",
                     roff(name), version, roff(name), roff(about));
}

std::string item_of(const ArgumentRow &row) {
  std::string item = ".TP\n";
  for (std::size_t i = 0; i < row.names.size(); ++i)
    item +=
        (i == 0 ? "" : ", ") + (row.names[i].starts_with('-') ? bold(row.names[i]) : italic(row.names[i]));
  const bool is_option = row.names.front().starts_with('-');
  if (is_option && !row.choices.empty())
    item += " " + bold(fmt::format("{}", fmt::join(row.choices, row.is_list ? "," : "|")));
  else if (is_option && !row.value.empty())
    item += " " + italic(row.value);
  return item + "\n" + roff(row.about) + "\n";
}

std::string exit_codes() {
  std::string text =
      ".SH EXIT STATUS\nAn error is one line on the standard error that names the file, the place "
      "in it, and what was expected.\n";
  for (const ExitCodeRow &row : exit_code_rows)
    text += fmt::format(".TP\n.B {}\n{}\n", row.code, roff(row.about));
  return text;
}

std::string in_synopsis(const ArgumentRow &operand) {
  const std::string text = italic(operand.names.front()) + (operand.is_repeated ? " ..." : "");
  return operand.is_required ? text : fmt::format("[{}]", text);
}

std::string items(const char *title, const std::vector<ArgumentRow> &rows) {
  std::string text = rows.empty() ? "" : fmt::format(".SH {}\n", title);
  for (const ArgumentRow &row : rows)
    text += item_of(row);
  return text;
}

// The columns of a line of --help, which stand at least two spaces apart.
std::vector<std::string> columns_of(const std::string &line) {
  std::vector<std::string> columns;
  for (std::size_t begin = line.find_first_not_of(' '); begin < line.size();) {
    const std::size_t end = std::min(line.find("  ", begin), line.size());
    columns.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(' ', end);
  }
  return columns;
}

std::string upper_case(std::string title) {
  std::ranges::transform(title, title.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return title;
}

// A footer of --help: titles that end with a colon, and below them tables whose rows are indented.
std::string sections_of(const std::string &footer) {
  std::string text;
  std::istringstream in(footer);
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> columns = columns_of(line);
    if (columns.empty())
      continue;
    if (!line.starts_with(' '))
      text += line.ends_with(':') ? fmt::format(".SH {}\n", upper_case(line.substr(0, line.size() - 1)))
                                  : fmt::format(".PP\n{}\n", roff(line));
    else
      text += fmt::format(".TP\n{}\n{}\n", bold(columns.front()),
                          roff(fmt::format("{}", fmt::join(columns.begin() + 1, columns.end(), ": "))));
  }
  return text;
}

std::string other_pages(const CommandTable &table, const std::string &but) {
  std::string text = ".SH SEE ALSO\n";
  std::string separator;
  if (but != table.program) {
    text += fmt::format(".BR {} (1)", roff(table.program));
    separator = ",\n";
  }
  for (const CommandRow &command : table.commands)
    if (const std::string name = table.program + "-" + command.name; name != but) {
      text += fmt::format("{}.BR {} (1)", separator, roff(name));
      separator = ",\n";
    }
  return text + "\n.PP\nThe documents in /usr/share/doc/pmdsim/docs where the package is installed.\n";
}

} // namespace

std::string man_page(const CommandTable &table, const std::string &version) {
  const std::size_t colon = table.about.find(": ");
  std::string page =
      head(table.program, version, table.about.substr(colon == std::string::npos ? 0 : colon + 2));
  page += fmt::format(".SH SYNOPSIS\n{0} {1}\n[{2} ...]\n", bold(table.program), italic("COMMAND"),
                      italic("OPTION"));
  page +=
      ".SH DESCRIPTION\nA setup, one JSON file, names a glTF scene, sensors and the diodes that light it. "
      "Each command has a manual page of its own.\n.SH COMMANDS\n";
  for (const CommandRow &command : table.commands)
    page += fmt::format(".TP\n{}\n{}\n", bold(command.name), roff(command.about));
  page += items("OPTIONS", table.options);
  page += exit_codes();
  page += environment;
  return page + other_pages(table, table.program);
}

std::string man_page(const CommandTable &table, const CommandRow &command, const std::string &version) {
  const std::string name = table.program + "-" + command.name;
  std::string page = head(name, version, command.about);
  page += fmt::format(".SH SYNOPSIS\n{}", bold(table.program + " " + command.name));
  for (const ArgumentRow &operand : command.operands)
    page += " " + in_synopsis(operand);
  page += fmt::format(" [{} ...]\n", italic("OPTION"));
  page += items("OPERANDS", command.operands);
  page += items("OPTIONS", command.options);
  page += sections_of(command.footer);
  page += exit_codes();
  return page + other_pages(table, name);
}

} // namespace pmdsim
