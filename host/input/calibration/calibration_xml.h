#pragma once
// OpenCV's FileStorage in XML, as the tree that its YAML would be.

#include <filesystem>
#include <string>
#include <yaml-cpp/yaml.h>

namespace pmdsim {

// What stands in <opencv_storage>. Its nodes have no places. Throws Error (input) for what is no such file,
// or is nested deeper than 32 elements.
YAML::Node parse_opencv_xml(const std::string &text, const std::filesystem::path &file);

} // namespace pmdsim
