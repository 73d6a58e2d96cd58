#pragma once
// What somebody who wrote a name that is not known may have meant.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// How many letters have to be put in, left out, replaced or swapped with their neighbours to make one of the
// other, upper and lower case alike (the optimal string alignment distance of Damerau and Levenshtein).
std::size_t edits_between(std::string_view a, std::string_view b);

// The nearest of `known`, the first of several; nothing where none is so near that it may be meant: within a
// third of the letters, or begun alike.
std::optional<std::string> nearest_name(std::string_view written, std::span<const std::string> known);

// ", did you mean \"NAME\"?"; empty where none is near.
std::string did_you_mean(std::string_view written, std::span<const std::string> known);

// "\"a\", \"b\" or \"c\"", or "\"a\", \"b\" and 7 more": as many as fit a line; `before_last` parts the last.
std::string listed_names(std::span<const std::string> names, std::string_view before_last = " or ");

} // namespace pmdsim
