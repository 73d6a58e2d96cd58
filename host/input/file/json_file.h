#pragma once
// JSON text from untrusted files: depth-limited, without doubled keys, errors in one line. And vectors in it.

#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string_view>

namespace pmdsim {

enum class Comments { refused, allowed };

inline constexpr std::size_t max_json_depth = 64; // objects and arrays within each other
// Numbers, texts, objects and arrays; one takes about 50 bytes, a text of the file perhaps 2.
inline constexpr std::size_t max_json_values = std::size_t{1} << 24;

// A number without a fractional part is an integer in the result, even if it is written as 8.0 or 2e7.
// `file` is named in errors only. Throws Error (input): "FILE:LINE:COLUMN: ..." for a syntax error, a number
// beyond double or bytes that are not UTF-8, "FILE:LINE:COLUMN: POINTER: ..." for a doubled key, "FILE: ..."
// for a document that is nested too deep or has more than max_json_values; (out_of_memory) where there is no
// room for its values.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path &file, Comments comments);

// What of that is thrown, without the document.
void check_json(std::string_view text, const std::filesystem::path &file, Comments comments);

} // namespace pmdsim

// A list of numbers as a vector: json.get<glm::dvec3>().
namespace glm {

template <class Json, length_t L, class T, qualifier Q>
void from_json(const Json &numbers, vec<L, T, Q> &vector) {
  for (length_t i = 0; i < L; ++i)
    numbers.at(static_cast<std::size_t>(i)).get_to(vector[i]);
}

} // namespace glm
