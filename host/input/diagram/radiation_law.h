#pragma once
// A diode's radiation law as a setup and a table of diodes name it: by a key of law_names and, where it has
// one, a number, whose limits are setup.schema.json's, or by the file of a diagram.

#include "engine/model/illuminator.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// The radiation diagrams that a setup names: IES LM-63 (.ies in any case), else CSV. Every file is read once,
// and all diodes that name it share its diagram.
class DiagramFiles {
public:
  // The diagram's shape: 1 on the axis, or at its maximum where the axis is dark, which also gives a warning.
  // Throws Error (input): "FILE:LINE: ..."; at `named_at`, the place that names the file, where it cannot be
  // read or is one too many.
  std::shared_ptr<const Diagram> read(const std::filesystem::path &file, const AnyPlace &named_at);

  // In the order of reading.
  const std::vector<Warning> &warnings() const { return warnings_; }

private:
  std::map<std::filesystem::path, std::shared_ptr<const Diagram>> diagrams_;
  std::size_t values_ = 0; // of all diagrams
  std::vector<Warning> warnings_;
};

// The law of a setup's `pattern`, which has passed the schema. Diagrams' files are named relative to the
// setup's folder.
Pattern law_in_setup(const nlohmann::ordered_json &pattern, const Place &place, DiagramFiles &diagrams);

// The law of a table's field: a key, a key and its number with a blank between them, a number alone, which is
// a cosine's order, or the name of a diagram's file, in the table's folder or below. Throws Error (input).
Pattern law_in_field(std::string_view field, const TextPlace &place, DiagramFiles &diagrams);

} // namespace pmdsim
