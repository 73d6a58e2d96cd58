#include "host/input/diagram/diagram_file.h"

#include "host/input/diagram/diagram_csv.h"
#include "host/input/diagram/ies_file.h"
#include "host/input/file/text_file.h"

#include <fmt/format.h>

namespace pmdsim {

namespace {

constexpr std::size_t max_values = std::size_t{1} << 24; // of all diagrams of a setup, 128 MiB

bool is_ies(const std::filesystem::path &file) {
  std::string extension = file.extension().string();
  for (char &c : extension)
    if (c >= 'A' && c <= 'Z')
      c = static_cast<char>(c - 'A' + 'a');
  return extension == ".ies";
}

} // namespace

std::shared_ptr<const Diagram> DiagramFiles::read(const std::filesystem::path &file,
                                                  const AnyPlace &named_at) {
  std::shared_ptr<const Diagram> &diagram = diagrams_[file.lexically_normal()];
  if (diagram)
    return diagram;
  const std::string text = read_text_file(file, named_at);
  DiagramTable table = is_ies(file) ? read_ies(file, text) : read_diagram_csv(file, text);
  values_ += table.values.size();
  if (values_ > max_values)
    throw input_error(named_at, fmt::format("expected at most {} values in all diagrams", max_values));
  diagram = std::make_shared<const Diagram>(diagram_of(std::move(table), warnings_));
  return diagram;
}

} // namespace pmdsim
