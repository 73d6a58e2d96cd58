// Topics for people and for programs.
#include "host/explain/topics.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t line_width = 100;

// The text in lines of at most line_width, `indent` spaces before each but the first.
std::string wrapped(const std::string &text, std::size_t indent) {
  std::string out;
  std::size_t used = indent;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    if (!out.empty() && used + 1 + word.size() > line_width) {
      out += '\n' + std::string(indent, ' ');
      used = indent;
    } else if (!out.empty()) {
      out += ' ';
      ++used;
    }
    out += word;
    used += word.size();
  }
  return out;
}

std::string fact(const char *name, const std::string &value) {
  return fmt::format("  {:<10}{}\n", name, wrapped(value, 12));
}

std::string capitalised(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text.ends_with('.') ? text : text + '.';
}

// With 0 for each *: what --set takes.
std::string settable(const std::string &path) {
  std::string text = path;
  for (std::size_t at = 0; (at = text.find('*', at)) != std::string::npos;)
    text.replace(at, 1, path.starts_with("nodes/") ? "NODE" : "0");
  return text;
}

std::string set_option(const SetupKey &key) {
  const bool is_plain = key.example.is_number() || key.example.is_boolean();
  const std::string change = settable(key.path) + "=" +
                             (key.example.is_string() ? key.example.get<std::string>() : key.example.dump());
  return fmt::format("--set {}", is_plain || key.example.is_string() ? change : "'" + change + "'");
}

// "in each of "sensors", in its "chip"".
std::string place_of(const SetupKey &key) {
  std::vector<std::string> around;
  std::istringstream in(key.path);
  for (std::string part; std::getline(in, part, '/');)
    around.push_back(part);
  around.pop_back();
  if (around.empty())
    return "at the setup's top";
  std::string text;
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around[i] != "*") {
      const bool is_list = i + 1 < around.size() && around[i + 1] == "*";
      text += fmt::format("{}{}{}", text.empty() ? "in " : ", in ", is_list ? "each of " : "",
                          ordered_json(around[i]).dump());
    }
  return key.beside.empty() ? text : text + ", beside " + key.beside;
}

std::string standard_text(const SetupKey &key) {
  if (key.standard)
    return key.standard->dump();
  return key.required ? "none, it has to be there" : "none, it may be left out";
}

std::string text_of(const SetupKey &key) {
  std::string text = fmt::format("{}\n  {}\n\n", key.path, wrapped(key.about, 2));
  text += fact("kind", "key of a setup") + fact("value", key.expected);
  if (!key.unit.empty())
    text += fact("unit", key.unit);
  text += fact("default", standard_text(key)) + fact("stands", place_of(key));
  if (!key.inside.empty())
    text += fact("keys", fmt::format("{}", fmt::join(key.inside, ", ")));
  const std::string name = key.path.substr(key.path.rfind('/') + 1);
  if (!key.example.is_null())
    text += fact("example", fmt::format("{}: {}", ordered_json(name).dump(), key.example.dump())) +
            fact("or", set_option(key));
  return text;
}

std::string channel_name(const ChannelTopic &channel) {
  return channel.name.substr(0, channel.name.find(','));
}

std::string text_of(const ChannelTopic &channel) {
  std::string text = fmt::format("{}\n  {}\n\n", channel.name, wrapped(capitalised(channel.about), 2));
  text += fact("kind", "channel that " + channel.command + " writes");
  if (!channel.unit.empty())
    text += fact("unit", channel.unit);
  if (channel.of_frequency)
    text += fact("of", "each frequency, with the prefix f0., f1., ... where there are several");
  return text + fact("example", channel.command == "correct"
                                    ? std::string("pmdsim correct SETUP IMAGE")
                                    : fmt::format("pmdsim {} SETUP --channels {}", channel.command,
                                                  channel_name(channel)));
}

std::string text_of(const ExitCodeRow &row) {
  std::string text = fmt::format("exit {}\n  {}\n\n", row.code, capitalised(std::string(row.about)));
  text += fact("kind", "exit code of the program");
  return row.remedy.empty() ? text : text + fact("then", std::string(row.remedy));
}

std::string text_of(const WarningKind &kind) {
  return fmt::format("{}\n  {}\n\n", kind.code, wrapped(std::string(kind.means), 2)) +
         fact("kind", "code of a warning; docs/warnings.md says what helps");
}

// The first words of a text, as many as fit.
std::string first_words(const std::string &text, std::size_t width) {
  if (text.size() <= width)
    return text;
  return text.substr(0, text.rfind(' ', width - 4)) + " ...";
}

std::string line_of(const std::string &name, const std::string &about) {
  constexpr std::size_t column = 42;
  const std::size_t begin = std::max(column, name.size() + 2);
  return fmt::format("  {:<{}}{}\n", name, begin, first_words(about, std::max<std::size_t>(40, 118 - begin)));
}

std::string line_of(const SetupKey &key) {
  return line_of(key.beside.empty() ? key.path : fmt::format("{} ({})", key.path, key.beside), key.about);
}
std::string line_of(const ChannelTopic &channel) { return line_of(channel.name, channel.about); }
std::string line_of(const ExitCodeRow &row) {
  return line_of(fmt::format("exit {}", row.code), std::string(row.about));
}

std::string line_of(const WarningKind &kind) {
  return line_of(std::string(kind.code), std::string(kind.means));
}

ordered_json json_of(const SetupKey &key) {
  ordered_json json{{"path", key.path},       {"about", key.about},       {"expected", key.expected},
                    {"unit", key.unit},       {"required", key.required}, {"default", nullptr},
                    {"example", key.example}, {"keys", key.inside}};
  json["default"] = key.standard ? *key.standard : nlohmann::json();
  if (!key.beside.empty())
    json["beside"] = key.beside;
  return json;
}

ordered_json json_of(const ChannelTopic &channel) {
  return {{"name", channel.name},
          {"about", channel.about},
          {"unit", channel.unit},
          {"of_frequency", channel.of_frequency},
          {"command", channel.command}};
}

ordered_json json_of(const ExitCodeRow &row) {
  return {{"code", row.code}, {"about", row.about}, {"remedy", row.remedy}};
}

ordered_json json_of(const WarningKind &kind) { return {{"code", kind.code}, {"means", kind.means}}; }

constexpr std::array<const char *, 4> list_names{"keys", "channels", "exit_codes",
                                                 "warnings"}; // in the variant's order
constexpr std::array<const char *, 4> titles{"Keys of a setup, * stands for an index or a name", "Channels",
                                             "Exit codes", "Warnings"};

} // namespace

std::string topics_text(const std::vector<Topic> &topics) {
  std::string text;
  for (const Topic &topic : topics)
    text += (text.empty() ? "" : "\n") + std::visit([](const auto &each) { return text_of(each); }, topic);
  return text;
}

std::string topic_lines(const std::vector<Topic> &topics) {
  std::string text;
  std::size_t kind = titles.size();
  for (const Topic &topic : topics) {
    if (topic.index() != kind)
      text += fmt::format("{}{}:\n", text.empty() ? "" : "\n", titles[kind = topic.index()]);
    text += std::visit([](const auto &each) { return line_of(each); }, topic);
  }
  return text;
}

ordered_json topics_json(const std::vector<Topic> &topics) {
  ordered_json json = ordered_json::object();
  for (const Topic &topic : topics)
    json[list_names[topic.index()]].push_back(
        std::visit([](const auto &each) { return json_of(each); }, topic));
  return json;
}

} // namespace pmdsim
