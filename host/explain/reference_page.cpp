#include "host/explain/topics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

// Text within a cell of a table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

std::string code(std::string_view text) { return text.empty() ? "" : fmt::format("`{}`", cell(text)); }

std::string folder_of(const SetupKey &key) {
  const std::size_t slash = key.path.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : key.path.substr(0, slash);
  return key.beside.empty() ? folder : fmt::format("{} with {}", folder, key.beside);
}

std::string title_of(const std::string &folder) {
  return folder.empty() ? "The setup's top" : "`" + folder + "`";
}

std::string standard_cell(const SetupKey &key) {
  if (key.standard)
    return code(key.standard->dump());
  return key.required ? "required" : "none";
}

// A table for the keys that stand together, in the order of the schema; those in deeper objects come below.
void add_keys(const std::vector<SetupKey> &keys, std::string &page) {
  std::vector<std::string> folders;
  for (const SetupKey &key : keys)
    if (std::ranges::find(folders, folder_of(key)) == folders.end())
      folders.push_back(folder_of(key));
  for (const std::string &folder : folders) {
    page += fmt::format("\n### {}\n\n| key | value | unit | default | meaning |\n|---|---|---|---|---|\n",
                        title_of(folder));
    for (const SetupKey &key : keys)
      if (folder_of(key) == folder)
        page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.path.substr(key.path.rfind('/') + 1),
                            cell(key.expected), key.unit, standard_cell(key), cell(key.about));
  }
}

std::string owner_of(const ChannelTopic &channel) {
  return channel.of_frequency ? "each frequency" : channel.command == "correct" ? "`correct`" : "the frame";
}

void add(const ChannelTopic &channel, std::string &page) {
  page += fmt::format("| `{}` | {} | {} | {} |\n", channel.name, cell(channel.unit), owner_of(channel),
                      cell(channel.about));
}

void add(const ExitCodeRow &row, std::string &page) {
  page += fmt::format("| {} | {} | {} |\n", row.code, row.about, cell(row.remedy));
}

void add(const WarningKind &kind, std::string &page) {
  page += fmt::format("| `{}` | {} |\n", kind.code, cell(kind.means));
}

void add(const SetupKey & /*key*/, std::string & /*page*/) {} // has been added with those around it

constexpr std::string_view beginning =
    R"(# Reference

All keys of a setup, all channels, exit codes and warnings, from the program's own tables: `pmdsim explain --markdown` prints
this page, and a test compares it. `pmdsim explain KEY` tells the same of one. [setup.md](setup.md) explains setups,
[outputs.md](outputs.md) what comes out, [commands.md](commands.md) the commands.

## Keys of a setup

In the paths below `*` stands for the index of an element, or the name of a node. An editor that knows JSON Schema
completes and explains keys by what `pmdsim schema` prints ([setup.md](setup.md#in-an-editor)).
)";

} // namespace

std::string reference_page() {
  std::string page(beginning);
  add_keys(setup_keys(), page);
  std::size_t kind = 0;
  for (const Topic &topic : all_topics()) {
    if (topic.index() != kind && topic.index() == 1)
      page += "\n## Channels\n\n| channel | unit | of | meaning |\n|---|---|---|---|\n";
    if (topic.index() != kind && topic.index() == 2)
      page += "\n## Exit codes\n\n| code | meaning | then |\n|---|---|---|\n";
    if (topic.index() != kind && topic.index() == 3)
      page +=
          "\n## Warnings\n\n[warnings.md](warnings.md) says what helps.\n\n| code | meaning |\n|---|---|\n";
    kind = topic.index();
    std::visit([&](const auto &each) { add(each, page); }, topic);
  }
  return page;
}

} // namespace pmdsim
