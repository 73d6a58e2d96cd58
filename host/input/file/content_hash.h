#pragma once
// A name for bytes that tells them from any others: not against intent, but against chance.

#include <string>
#include <string_view>

namespace pmdsim {

// XXH3 of 128 bits (xxhash.com), as 32 hexadecimal digits, the same on every machine.
std::string content_hash(std::string_view bytes);

} // namespace pmdsim
