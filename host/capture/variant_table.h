#pragma once
// The table of results of variants: a row for each variant, frame and sensor.

#include "host/capture/variants.h"
#include "host/output/files/manifest.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// What a frame's record tells of it for the table: of each frequency the least, the median and the greatest
// distance and amplitude, the same of the true range, and the mean coverage; null of channels that are not
// there.
nlohmann::ordered_json frame_summary(const Measurement &frame);

class VariantTable {
public:
  // Of variants that change these paths, each in a column of its own.
  explicit VariantTable(const std::vector<Variant> &variants);

  // A frame of one sensor, as its record has it, whose "told" is frame_summary(); without it where the frame
  // was there before, by a command that makes no table.
  void add(const Variant &variant, const nlohmann::ordered_json &of_sensor);

  bool empty() const { return rows_.empty(); }
  // Into the directory; its path. Throws Error (output).
  std::string write(const std::filesystem::path &directory, const std::string &name) const;
  // For people: variant, sensor, frame, distances and amplitude of the first frequency.
  std::string text() const;

private:
  nlohmann::ordered_json no_changes_; // a null for each path
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

} // namespace pmdsim
