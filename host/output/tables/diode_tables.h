#pragma once
// A study of diodes' errors, for scripts and people. Columns and keys: docs/diodes.md, "The files".

#include "host/output/tables/diode_study.h"

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim {

nlohmann::ordered_json diode_study_json(const DiodeStudy &study);

// A line a diode, a kind of error, an illuminator's fault, a pixel with random boards, after a header line.
std::string diodes_csv(const DiodeStudy &study);
std::string board_csv(const DiodeStudy &study);
std::string alike_csv(const DiodeStudy &study);
std::string pixels_csv(const DiodeStudy &study);

// For people: what one diode does, what a board does, which diodes matter, and which tolerance.
std::string diode_study_text(const DiodeStudy &study);

} // namespace pmdsim
