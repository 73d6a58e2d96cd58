#pragma once
// The options that only `correct` has.

#include "host/correction/measured_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pmdsim {

// `--truth scene` takes the ranges of the setup's own scene.
inline constexpr const char *truth_of_scene = "scene";

struct CorrectOptions {
  ImageRequest image;
  std::string sensor;      // by its name; empty: the first
  std::uint32_t frame = 0; // of a setup that moves
  NormalsFrom normals = NormalsFrom::neighbours;
  std::uint32_t fit_pixels = 0; // as CorrectionOptions
  std::string truth;            // a file, `scene`, or empty
};

// As they are written.
struct WrittenCorrect {
  CorrectOptions options;
  std::optional<std::string> quantity, unit, least_range, unwrap, normals;
};

void add_correct(CLI::App &command, WrittenCorrect &written);

// Throws Error (usage).
CorrectOptions correct_options_of(const WrittenCorrect &written);

} // namespace pmdsim
