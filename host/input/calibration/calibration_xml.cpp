#include "host/input/calibration/calibration_xml.h"

#include "host/input/file/input_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

namespace pmdsim {
namespace {

constexpr int deepest = 32;

// Numbers that stand one after the other are a list, as in <data>.
YAML::Node words_of(const std::string &text) {
  YAML::Node list(YAML::NodeType::Sequence);
  std::istringstream in(text);
  for (std::string word; in >> word;)
    list.push_back(word);
  return list;
}

YAML::Node node_of(const pugi::xml_node &element, int depth, const std::filesystem::path &file) {
  if (depth > deepest)
    throw input_error(Place{file}, fmt::format("expected elements nested at most {} deep", deepest));
  const auto children = element.children();
  const bool has_elements = std::any_of(children.begin(), children.end(), [](const pugi::xml_node &child) {
    return child.type() == pugi::node_element;
  });
  if (!has_elements) {
    const std::string text = element.text().as_string();
    const YAML::Node words = words_of(text);
    return std::string_view(element.name()) == "data" || words.size() > 1 ? words : YAML::Node(text);
  }
  YAML::Node node;
  for (const pugi::xml_node &child : children) {
    if (child.type() != pugi::node_element)
      continue;
    if (std::string_view(child.name()) == "_") // an element of a list
      node.push_back(node_of(child, depth + 1, file));
    else
      node.force_insert(std::string(child.name()), node_of(child, depth + 1, file));
  }
  return node;
}

// The line on which a byte of the text lies, and its place in it, from 1.
TextPlace place_at(const std::string &text, std::ptrdiff_t byte, const std::filesystem::path &file) {
  const std::string_view before =
      std::string_view(text).substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(byte, 0)));
  const auto line_begin = before.rfind('\n') + 1; // 0 where there is none
  return {file, static_cast<std::size_t>(std::ranges::count(before, '\n')) + 1,
          before.size() - line_begin + 1};
}

} // namespace

YAML::Node parse_opencv_xml(const std::string &text, const std::filesystem::path &file) {
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result)
    throw input_error(place_at(text, result.offset, file),
                      fmt::format("not valid XML: {}", result.description()));
  const pugi::xml_node storage = document.child("opencv_storage");
  if (!storage)
    throw input_error(Place{file}, "expected OpenCV's <opencv_storage> in XML");
  return node_of(storage, 0, file);
}

} // namespace pmdsim
