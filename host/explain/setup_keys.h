#pragma once
// The keys of a setup as a list, read off its JSON Schema.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

struct SetupKey {
  std::string path;     // from the setup's top; * stands for an index or a name: "sensors/*/taps"
  std::string beside{}; // what has to stand beside it: "\"model\": \"fisheye\""; empty: nothing
  std::string about;    // the schema's description
  std::string expected; // "an integer from 3 to 16"
  std::string unit;     // "metres"; empty where its value is no number or a pure one
  bool required;        // where the object that it stands in is there
  std::optional<nlohmann::json> standard{}; // what it is where it is left out
  nlohmann::json example{};                 // null where the schema has none
  std::vector<std::string> inside{};        // the names of the keys in its value
};

// All, each before those inside it.
const std::vector<SetupKey> &setup_keys();

// The keys that the words of a user mean: a key's name, or a JSON pointer or the end of one, with or without
// its first slash, such as focal_length_m, sensors/0/taps or distortion/k1.
std::vector<SetupKey> keys_meant(std::string_view words);

} // namespace pmdsim
