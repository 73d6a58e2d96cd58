#pragma once
// The text of a new setup, with a comment for each line.

#include "host/start/kinds.h"

#include <string>

namespace pmdsim {

// The names of the files that a new setup consists of.
inline constexpr const char *start_setup_file = "setup.json", *start_scene = "scene",
                            *start_schema_file = "setup.schema.json", *start_diodes_file = "diodes.csv";
// Nodes of its scene.
inline constexpr const char *camera_node = "Camera", *light_node = "Light";

// The rings' diodes as a table, which a setup may name in place of them.
std::string diodes_text(const StartView &view);

std::string setup_text(const StartKind &kind, const StartSizes &sizes, const StartScene &scene);

// The whole angles that the view sees across and upright, radians.
glm::dvec2 view_rad(const StartView &view);

} // namespace pmdsim
