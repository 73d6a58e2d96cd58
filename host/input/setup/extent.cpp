#include "host/input/setup/extent.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

using nlohmann::json;

std::size_t checked_values(const json &value, const Place &place) {
  if (!value.is_structured())
    return 1;
  if (value.size() > max_setup_entries)
    throw input_error(place,
                      fmt::format("expected at most {} entries, found {}", max_setup_entries, value.size()));
  std::size_t values = 1, index = 0;
  for (const auto &[key, each] : value.items()) {
    values +=
        checked_values(each, each.is_structured() ? (value.is_array() ? place / index : place / key) : place);
    ++index;
  }
  return values;
}

} // namespace

void check_extent(const json &document, const Place &root) {
  const std::size_t values = checked_values(document, root);
  if (values > max_setup_values)
    throw input_error(root, fmt::format("expected at most {} values, found {}", max_setup_values, values));
}

} // namespace pmdsim
