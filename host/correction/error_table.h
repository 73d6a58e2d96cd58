#pragma once
// How far ranges are off the truth, before and after they are corrected.

#include "engine/correction/correction.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// In micrometres; NaN where there is no pixel.
struct ErrorFigures {
  double mean_um, rms_um;                  // of the errors
  double median_um, most_of_95_um, max_um; // of their sizes
};

struct ErrorRow {
  std::string pixels; // which: "interior"
  std::size_t count = 0;
  ErrorFigures before{}, after{}; // of the measured distances and of the corrected ranges
};

// Rows for the pixels that are corrected and have a true range: interior, edge, and where `lit` is not empty
// apart from both those that not all diodes reach.
std::vector<ErrorRow> error_rows(const CorrectedImage &corrected, const std::vector<double> &true_range_m,
                                 const std::vector<double> &lit);

// How many of these pixels are off by about whole ambiguity ranges: their turn is wrong.
std::size_t wrong_turns(const CorrectedImage &corrected, const std::vector<double> &true_range_m,
                        double ambiguity_m);

std::string error_text(const std::vector<ErrorRow> &rows);
nlohmann::ordered_json error_json(const std::vector<ErrorRow> &rows);

} // namespace pmdsim
