#include "host/input/gltf/uri.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <string_view>

namespace pmdsim {

namespace fs = std::filesystem;

namespace {

// RFC 3986 percent-decoding; nothing where a % is not followed by two hexadecimal digits or hides a NUL.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned code = 0;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16).ptr;
    if (digits.size() != 2 || end != digits.data() + 2 || code == 0)
      return std::nullopt;
    decoded.push_back(static_cast<char>(code));
    i += 2;
  }
  return decoded;
}

// RFC 3986, section 3.1: a letter, then letters, digits, +, - and . up to the colon.
bool has_scheme(std::string_view uri) {
  const std::string_view scheme = uri.substr(0, uri.find(':'));
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_allowed = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
  };
  return scheme.size() < uri.size() && !scheme.empty() && is_letter(scheme[0]) &&
         std::all_of(scheme.begin(), scheme.end(), is_allowed);
}

bool lies_inside(const fs::path &folder, const fs::path &file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

} // namespace

fs::path folder_of(const fs::path &file) { return file.has_parent_path() ? file.parent_path() : "."; }

fs::path file_in_folder(const std::string &uri, const fs::path &folder, const Place &place) {
  if (has_scheme(uri))
    throw input_error(place, "expected a relative file name or a data: URI, found " + in_quotes(uri));
  const std::optional<std::string> name = percent_decoded(uri);
  if (!name)
    throw input_error(place, "expected a percent-encoded relative path, found " + in_quotes(uri));
  std::error_code unresolved;
  const fs::path inside = fs::weakly_canonical(folder, unresolved);
  fs::path file = unresolved ? fs::path{} : fs::weakly_canonical(folder / *name, unresolved);
  if (unresolved)
    throw input_error(place, fmt::format("{}: {}", in_quotes(uri), unresolved.message()));
  if (fs::path(*name).is_absolute() || !lies_inside(inside, file))
    throw input_error(place, fmt::format("{} lies outside the scene's folder", in_quotes(uri)));
  return file;
}

} // namespace pmdsim
