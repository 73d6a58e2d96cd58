#include "host/input/diagram/radiation_law.h"

#include "host/input/diagram/diagram_table.h"
#include "host/input/file/input_file.h"
#include "host/input/file/inside_folder.h"
#include "host/input/schema/schema_check.h"
#include "host/input/words/file_kind.h"
#include "host/input/words/near_file.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr std::size_t max_values = std::size_t{1} << 24; // of all diagrams of a setup, 128 MiB

bool is_ies(const std::filesystem::path &file) {
  return std::ranges::equal(file.extension().native(), std::string_view(".ies"), {},
                            [](unsigned char c) { return std::tolower(c); });
}

Pattern numbered(const LawName &law, double number) {
  Pattern pattern{static_cast<Pattern::Kind>(&law - law_names.data())};
  if (law.number != nullptr)
    pattern.*law.number = number;
  return pattern;
}

// The law that a number alone means in a table of diodes.
const LawName &cosine = law_names[static_cast<std::size_t>(Pattern::Kind::cosine)];

// The limits of the number behind a law's key.
NumberRange limits_of(const LawName &law) {
  static const json schema = json::parse(setup_schema_text);
  static const json &laws =
      schema.at("properties").at("illuminators").at("items").at("properties").at("pattern").at("anyOf");
  const auto of_law = std::ranges::find_if(
      laws, [&](const json &alternative) { return alternative.at("properties").contains(law.key); });
  const json &number = of_law->at("properties").at(law.key);
  return {number.at("minimum").get<double>(), number.at("maximum").get<double>()};
}

// A text that is written like a number is one, if a wrong one; a file of that name is "./1.5".
bool is_number_like(std::string_view text) {
  constexpr std::string_view first = "0123456789.+-";
  return first.find(text.front()) != first.npos && text.find_first_not_of("0123456789.+-eE") == text.npos;
}

constexpr const char *pattern_expected = "expected an order such as 1, isotropic, or a diagram's file name";

// What a field that names no file may have been meant by, as the end of a message.
std::string hint_of_pattern(std::string_view field, const std::filesystem::path &file) {
  std::string word(field);
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return std::tolower(c); });
  if (word.starts_with("lambert") || word == "cos" || word == "cosine")
    return "; Lambert's law is the order 1";
  if (const std::string meant = did_you_mean(field, std::vector<std::string>{"isotropic"}); !meant.empty())
    return meant;
  return absent_file_hint(file);
}

} // namespace

std::shared_ptr<const Diagram> DiagramFiles::read(const std::filesystem::path &file,
                                                  const AnyPlace &named_at) {
  std::shared_ptr<const Diagram> &diagram = diagrams_[file.lexically_normal()];
  if (diagram)
    return diagram;
  const std::string text = read_text_file(file, named_at);
  if (const std::string kind = kind_of_file(file, text); !is_ies(file) && !kind.empty())
    throw input_error(Place{file},
                      fmt::format("is {}, expected IES (.ies) or a table of angles (CSV)", kind));
  DiagramTable table = is_ies(file) ? read_ies(file, text) : read_diagram_csv(file, text);
  values_ += table.values.size();
  if (values_ > max_values)
    throw input_error(named_at, fmt::format("expected at most {} values in all diagrams", max_values));
  diagram = std::make_shared<const Diagram>(diagram_of(std::move(table), warnings_));
  return diagram;
}

Pattern law_in_setup(const ordered_json &pattern, const Place &place, DiagramFiles &diagrams) {
  for (const LawName &law : law_names)
    if (const auto value = pattern.find(law.key); value != pattern.end() && !value->is_string())
      return numbered(law, value->is_number() ? value->get<double>() : 0.0);
  const std::filesystem::path file = place.folder / pattern.at("file").get<std::string>();
  return {Pattern::Kind::diagram, 0.0, diagrams.read(file, place / "file")};
}

Pattern law_in_field(std::string_view field, const TextPlace &place, DiagramFiles &diagrams) {
  if (field.empty())
    throw input_error(place, std::string("pattern: ") + pattern_expected);
  if (is_number_like(field))
    return numbered(cosine, number_of(field, "pattern", place, limits_of(cosine)));
  const std::string_view key = field.substr(0, field.find(' '));
  const bool has_number = key.size() < field.size();
  for (const LawName &law : law_names)
    if (key == law.key && has_number == (law.number != nullptr) && key != "file")
      return has_number
                 ? numbered(law, number_of(field.substr(key.size() + 1), "pattern", place, limits_of(law)))
                 : numbered(law, 0.0);
  const std::filesystem::path file = place.file.parent_path() / field;
  std::error_code unresolved, ignored;
  const bool is_inside = lies_inside(place.file.parent_path(), field, unresolved);
  if (unresolved)
    throw input_error(place, fmt::format("pattern: {}: {}", in_quotes(field), unresolved.message()));
  if (!is_inside)
    throw input_error(place,
                      fmt::format("pattern: {} lies outside the table's folder, expected a file there; "
                                  "a setup's \"pattern\" may name others",
                                  in_quotes(field)));
  if (std::filesystem::status(file, ignored).type() == std::filesystem::file_type::not_found)
    throw input_error(place, fmt::format("pattern: {}, found {}: no such file{}", pattern_expected,
                                         in_quotes(field), hint_of_pattern(field, file)));
  return {Pattern::Kind::diagram, 0.0, diagrams.read(file, place)};
}

} // namespace pmdsim
