#pragma once
// The files of radiation diagrams that a setup names: IES LM-63 (.ies in any case), else CSV.

#include "engine/model/illuminator.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

// A setup's diagrams. Every file is read once, and all diodes that name it share its diagram.
class DiagramFiles {
public:
  // The diagram's shape: 1 on the axis, or at its maximum where the axis is dark, of which there is a warning
  // then. Throws Error (input): "FILE:LINE: ..."; at `named_at`, the place that names the file, where it
  // cannot be read or is one too many.
  std::shared_ptr<const Diagram> read(const std::filesystem::path &file, const AnyPlace &named_at);

  // One line each, in the order of reading.
  const std::vector<std::string> &warnings() const { return warnings_; }

private:
  std::map<std::filesystem::path, std::shared_ptr<const Diagram>> diagrams_;
  std::size_t values_ = 0; // of all diagrams
  std::vector<std::string> warnings_;
};

} // namespace pmdsim
