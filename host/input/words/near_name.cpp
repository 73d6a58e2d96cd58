#include "host/input/words/near_name.h"

#include "host/input/words/quotes.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <numeric>

namespace pmdsim {
namespace {

constexpr std::size_t longest_compared = 100;

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

bool begins_with(std::string_view whole, std::string_view begin) {
  return whole.size() >= begin.size() &&
         std::ranges::equal(whole.substr(0, begin.size()), begin, same_letter);
}

// Fewer is nearer; nothing where it is not near at all.
std::optional<std::size_t> remoteness(std::string_view written, std::string_view known) {
  constexpr std::size_t least_begin = 3;
  if (written.size() > longest_compared || known.size() > longest_compared)
    return std::nullopt;
  const std::size_t edits = edits_between(written, known);
  const std::size_t longer = std::max(written.size(), known.size());
  if (3 * edits <= longer)
    return edits;
  const std::size_t shorter = std::min(written.size(), known.size());
  if (shorter >= least_begin && (begins_with(known, written) || begins_with(written, known)))
    return edits + longer;
  return std::nullopt;
}

} // namespace

std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) && same_letter(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<std::string> nearest_name(std::string_view written, std::span<const std::string> known) {
  std::optional<std::string> nearest;
  std::size_t least = 0;
  for (const std::string &name : known)
    if (const auto far = remoteness(written, name); far && (!nearest || *far < least)) {
      nearest = name;
      least = *far;
    }
  return nearest;
}

std::string did_you_mean(std::string_view written, std::span<const std::string> known) {
  const auto nearest = nearest_name(written, known);
  return nearest ? fmt::format(", did you mean {}?", in_quotes(*nearest)) : "";
}

std::string listed_names(std::span<const std::string> names, std::string_view before_last) {
  constexpr std::size_t longest_line = 200;
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = in_quotes(names[i]);
    if (i > 0 && list.size() + name.size() > longest_line)
      return fmt::format("{} and {} more", list, names.size() - i);
    list += std::string(i == 0 ? "" : i + 1 == names.size() ? before_last : ", ") + name;
  }
  return list;
}

} // namespace pmdsim
