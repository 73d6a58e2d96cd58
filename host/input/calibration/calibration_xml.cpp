#include "host/input/calibration/calibration_xml.h"

#include "host/input/calibration/calibration_yaml.h"
#include "host/input/file/input_error.h"

#include <algorithm>
#include <fmt/format.h>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>

namespace pmdsim {
namespace {

constexpr int deepest = 32;

class Tree {
public:
  explicit Tree(const std::filesystem::path &file) : place_{file} {}

  YAML::Node node_of(const pugi::xml_node &element, int depth = 0) {
    if (depth > deepest)
      throw input_error(place_, fmt::format("expected elements nested at most {} deep", deepest));
    const auto children = element.children();
    const auto is_element = [](const pugi::xml_node &child) { return child.type() == pugi::node_element; };
    if (std::none_of(children.begin(), children.end(), is_element))
      return value_of(element);
    YAML::Node node;
    for (const pugi::xml_node &child : children)
      if (is_element(child))
        add(child, node_of(child, depth + 1), element, node);
    return node;
  }

private:
  // Numbers that stand one after the other are a list, as in <data>.
  YAML::Node value_of(const pugi::xml_node &element) {
    const std::string text = element.text().as_string();
    YAML::Node list(YAML::NodeType::Sequence);
    std::istringstream in(text);
    for (std::string word; in >> word; count())
      list.push_back(word);
    return std::string_view(element.name()) == "data" || list.size() > 1 ? list : YAML::Node(text);
  }

  void add(const pugi::xml_node &child, const YAML::Node &value, const pugi::xml_node &element,
           YAML::Node &node) {
    count();
    const bool is_of_list = std::string_view(child.name()) == "_";
    if (is_of_list ? node.IsMap() : node.IsSequence())
      throw input_error(place_, fmt::format("expected elements of a list, <_>, or others in <{}>, found both",
                                            element.name()));
    if (is_of_list)
      node.push_back(value);
    else
      node.force_insert(std::string(child.name()), value);
  }

  // A value takes some hundred times the memory of its text.
  void count() {
    if (++values_ > max_yaml_values)
      throw input_error(place_, fmt::format("expected at most {} values", max_yaml_values));
  }

  Place place_;
  std::size_t values_ = 0;
};

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
  return Tree(file).node_of(storage);
}

} // namespace pmdsim
