#pragma once
// Queries of a directory that was written to.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

inline std::set<std::string> names_in(const std::filesystem::path &directory) {
  std::set<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(directory))
    names.insert(entry.path().filename().string());
  return names;
}

inline std::string content_of(const std::filesystem::path &file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}
