#pragma once
// Variants of setups: what each changes, and where its frames go.

#include "host/input/setup/document.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// A setup's document, changed.
struct Variant {
  std::string name; // of its folder within the output directory
  SetupDocument document;
  nlohmann::json changes; // as change() takes them; an empty object: none
};

// Poses from a file, along which something moves; frames are taken at their times.
struct PosesFromFile {
  std::string name; // of a sensor, an illuminator or a node; empty: the first sensor
  std::filesystem::path file;
};

// The name of the folder of the setup's frames: the file's, without its ending. Throws Error (usage) where
// that leads elsewhere: "...json".
std::string frames_folder_of(const std::filesystem::path &setup);

// The changes that make a document's sensor, illuminator or node move along them. Throws Error (input) where
// there is no such file.
nlohmann::json changes_for(const PosesFromFile &poses, const SetupDocument &document);

// A line of a file of variants.
struct VariantLine {
  std::size_t line;       // from 1
  nlohmann::json changes; // an object
};

// The lines of a file of JSON Lines, without blank ones. Throws Error (input).
std::vector<VariantLine> read_variants(const std::filesystem::path &file);

// Every setup with every variant of it: named SETUP where there are several setups, 0000, 0001, ... where
// there are variants, SETUP/0000 with both. Throws Error: input; usage, of two setups of one name.
std::vector<Variant> variants_of(const std::vector<SetupDocument> &setups,
                                 const std::optional<std::filesystem::path> &variants);

} // namespace pmdsim
