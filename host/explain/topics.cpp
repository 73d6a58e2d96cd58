#include "host/explain/topics.h"

#include "engine/correction/corrected_channels.h"
#include "engine/model/channel_names.h"
#include "engine/model/error.h"
#include "host/input/file/input_error.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <optional>
#include <sstream>

namespace pmdsim {
namespace {

const ChannelTopic deformation{"deformation_mm", "mm",
                               "bistatic minus monostatic distance, wrapped to -c / (4 f) to c / (4 f)", true,
                               "deform"};

ChannelTopic channel_topic(const ChannelRow &row) {
  const std::string name = is_of_taps(row) ? fmt::format("{0}0, {0}1, ...", row.name) : std::string(row.name);
  return {name, std::string(row.unit), std::string(row.about), is_of_frequency(row), "render"};
}

ChannelTopic corrected_topic(const CorrectedChannelRow &row) {
  return {std::string(row.name), std::string(row.unit), std::string(row.about), false, "correct"};
}

// A name may be of channels of several commands.
std::vector<Topic> channels_meant(const std::string &word) {
  std::vector<Topic> topics;
  if (word == deformation.name)
    topics.emplace_back(deformation);
  if (const ChannelRow *row = channel_named(word).row)
    topics.emplace_back(channel_topic(*row));
  for (const CorrectedChannelRow &row : corrected_channel_rows)
    if (word == row.name)
      topics.emplace_back(corrected_topic(row));
  return topics;
}

std::optional<Topic> exit_code_meant(const std::string &word) {
  int code = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), code);
  const auto row = std::ranges::find(exit_code_rows, code, &ExitCodeRow::code);
  const bool is_known =
      error == std::errc() && end == word.data() + word.size() && row != exit_code_rows.end();
  return is_known ? std::optional<Topic>(*row) : std::nullopt;
}

std::optional<Topic> warning_meant(const std::string &word) {
  const auto kind = std::ranges::find(warning_kinds, word, &WarningKind::code);
  return kind == warning_kinds.end() ? std::nullopt : std::optional<Topic>(*kind);
}

// "exit 8" in quotes is two words, too.
std::vector<std::string> words_in(const std::string &text) {
  std::istringstream in(text);
  const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
  return words.empty() ? std::vector<std::string>{text} : words;
}

// Names that hold the word or begin as it does.
std::vector<std::string> near_names(const std::string &word) {
  constexpr std::size_t most = 8;
  const std::string begin = word.substr(0, std::max<std::size_t>(4, word.size() / 2));
  std::vector<std::string> near;
  for (const std::string &name : topic_names())
    if (near.size() < most && (name.find(word) != std::string::npos || name.starts_with(begin)))
      near.push_back(name);
  return near;
}

[[noreturn]] void refuse(const std::string &word) {
  const std::vector<std::string> near = near_names(word);
  throw Error(ExitCode::usage, fmt::format("explain: expected a key of a setup, a channel, a warning's code, "
                                           "or `exit` and a code, found {}; {}",
                                           in_quotes(word),
                                           near.empty() ? "`pmdsim explain` lists all"
                                                        : fmt::format("near are {}", fmt::join(near, ", "))));
}

// A name may be of keys and of channels.
std::vector<Topic> topics_of_word(const std::string &word) {
  std::vector<Topic> topics;
  if (const auto code = exit_code_meant(word))
    return {*code};
  std::ranges::copy(keys_meant(word), std::back_inserter(topics));
  std::ranges::copy(channels_meant(word), std::back_inserter(topics));
  if (const auto warning = warning_meant(word))
    topics.push_back(*warning);
  if (topics.empty())
    refuse(word);
  return topics;
}

} // namespace

std::vector<Topic> all_topics() {
  std::vector<Topic> topics(setup_keys().begin(), setup_keys().end());
  std::ranges::transform(channel_rows, std::back_inserter(topics), channel_topic);
  topics.emplace_back(deformation);
  std::ranges::transform(corrected_channel_rows, std::back_inserter(topics), corrected_topic);
  std::ranges::copy(exit_code_rows, std::back_inserter(topics));
  std::ranges::copy(warning_kinds, std::back_inserter(topics));
  return topics;
}

std::vector<Topic> topics_of(const std::vector<std::string> &written) {
  std::vector<std::string> words;
  for (const std::string &text : written)
    std::ranges::copy(words_in(text), std::back_inserter(words));
  std::vector<Topic> topics;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string &word = words[i];
    const bool is_exit = word == "exit" || word == "exit-code";
    if (is_exit && i + 1 < words.size() && exit_code_meant(words[i + 1]))
      topics.push_back(*exit_code_meant(words[++i]));
    else if (is_exit)
      std::ranges::copy(exit_code_rows, std::back_inserter(topics));
    else
      std::ranges::copy(topics_of_word(word), std::back_inserter(topics));
  }
  return topics;
}

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  for (const SetupKey &key : setup_keys())
    names.push_back(key.path.substr(key.path.rfind('/') + 1));
  for (const ChannelRow &row : channel_rows)
    names.emplace_back(row.name);
  names.push_back(deformation.name);
  for (const CorrectedChannelRow &row : corrected_channel_rows)
    names.emplace_back(row.name);
  for (const WarningKind &kind : warning_kinds)
    names.emplace_back(kind.code);
  names.emplace_back("exit");
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

} // namespace pmdsim
