#pragma once
// Text that others wrote, in messages.

#include <string>
#include <string_view>

namespace pmdsim {

// Text from an input file as it may stand in a message: in double quotes, escaped, of bounded length.
std::string in_quotes(std::string_view text);

} // namespace pmdsim
