#pragma once
// Which call is to fail: the environment variable PMDSIM_FAULT names it to the libraries of this folder,
// which are loaded into the program beside its own. "KIND:N" is the N-th call of a kind (malloc, open, write,
// vkQueueSubmit2 and so on; from 1), "KIND:N+" that and all after it, "KIND:N:CODE" gives errno or VkResult
// instead of the usual one. Of calls of the device there may be two, with a comma between them.

#include <array>
#include <cstdlib>
#include <cstring>

namespace pmdsim::faults {

inline constexpr const char *plan_variable = "PMDSIM_FAULT";
// A file to which the number of calls of each kind is appended as the program ends: "KIND COUNT" a line.
inline constexpr const char *counts_variable = "PMDSIM_FAULT_COUNTS";

struct Plan {
  char kind[64] = ""; // empty: nothing fails
  long first = 0;     // of the calls that fail
  bool all_after = false;
  int code = 0; // 0: the usual one

  bool fails(const char *called, long number) const {
    return std::strcmp(kind, called) == 0 && (number == first || (all_after && number > first));
  }
};

// Allocates nothing, as the calls that fail may be those for memory.
inline Plan plan_of(const char *text) {
  Plan plan;
  const char *colon = text ? std::strchr(text, ':') : nullptr;
  if (!colon || colon - text >= static_cast<long>(sizeof plan.kind))
    return plan;
  std::memcpy(plan.kind, text, static_cast<std::size_t>(colon - text));
  char *rest = nullptr;
  plan.first = std::strtol(colon + 1, &rest, 10);
  plan.all_after = *rest == '+';
  rest += plan.all_after ? 1 : 0;
  plan.code = *rest == ':' ? std::atoi(rest + 1) : 0;
  return plan;
}

inline std::array<Plan, 2> plans_of(const char *text) {
  const char *comma = text ? std::strchr(text, ',') : nullptr;
  return {plan_of(text), plan_of(comma ? comma + 1 : nullptr)};
}

} // namespace pmdsim::faults
