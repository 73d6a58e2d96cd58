#pragma once
// What a user may ask about: keys of a setup, channels, exit codes, warnings.

#include "engine/model/channels.h"
#include "engine/model/warning.h"
#include "host/explain/setup_keys.h"
#include "host/manual/exit_codes.h"

#include <nlohmann/json.hpp>
#include <string>
#include <variant>
#include <vector>

namespace pmdsim {

// A channel as `render`, `deform` or `correct` writes it.
struct ChannelTopic {
  std::string name; // "tap0, tap1, ..."
  std::string unit; // empty: none
  std::string about;
  bool of_frequency; // once for each, with the prefix f0., f1., ... where there are several
  std::string command;
};

using Topic = std::variant<SetupKey, ChannelTopic, ExitCodeRow, WarningKind>;

// All topics, kind by kind.
std::vector<Topic> all_topics();

// What the words mean, e.g. {"taps", "f1.multipath_m", "nothing-in-view", "exit", "8"}; a number alone is an
// exit code. Throws Error (usage) for a word that means nothing, with what comes near.
std::vector<Topic> topics_of(const std::vector<std::string> &words);

// Words that topics_of() knows, for completions: names of keys, each once, of channels, and codes of
// warnings.
std::vector<std::string> topic_names();

// For people: the whole of each topic, or a line for each.
std::string topics_text(const std::vector<Topic> &topics);
std::string topic_lines(const std::vector<Topic> &topics);
// {"keys": [...], "channels": [...], "exit_codes": [...], "warnings": [...]}, each only where there are any.
nlohmann::ordered_json topics_json(const std::vector<Topic> &topics);

// docs/reference.md.
std::string reference_page();

} // namespace pmdsim
