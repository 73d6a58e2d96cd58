#pragma once
// A diode's radiation law as a setup and a table of diodes name it: by a key of law_names and, where it has
// one, a number, whose limits are setup.schema.json's.

#include "engine/model/illuminator.h"
#include "host/input/diagram/diagram_file.h"
#include "host/input/file/text_file.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace pmdsim {

// Of a setup's `pattern`, which the schema holds for right. Diagrams' files are named relative to the
// setup's folder.
Pattern law_in_setup(const nlohmann::ordered_json &pattern, const Place &place, DiagramFiles &diagrams);

// Of a table's field: a key, a key and its number with a blank between them, a number alone, which is a
// cosine's order, or the name of a diagram's file, relative to the table's folder. Throws Error (input).
Pattern law_in_field(std::string_view field, const TextPlace &place, DiagramFiles &diagrams);

} // namespace pmdsim
