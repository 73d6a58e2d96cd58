#include "host/input/words/quotes.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 80;
  const bool cut = text.size() > longest;
  const nlohmann::json shown = std::string(text.substr(0, longest)) + (cut ? "..." : "");
  return shown.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

} // namespace pmdsim
