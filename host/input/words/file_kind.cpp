#include "host/input/words/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace pmdsim {
namespace {

using Mark = std::pair<std::string_view, std::string_view>;

constexpr std::array<Mark, 16> first_bytes{
    {{"glTF", "a binary glTF scene (.glb)"},
     {"\x1f\x8b", "a file that gzip has packed"},
     {"PK\x03\x04", "a zip archive, as .xlsx and .usdz are"},
     {"7z\xbc\xaf", "a 7-Zip archive"},
     {"Kaydara FBX", "an FBX scene"},
     {"BLENDER", "a Blender file"},
     {"\x28\xb5\x2f\xfd", "a file that zstd has packed (Blender's, perhaps)"},
     {"ply\n", "a PLY mesh"},
     {"ply\r\n", "a PLY mesh"},
     {"solid ", "an STL mesh"},
     {"\x89PNG", "a PNG picture"},
     {"v/1\x01", "an EXR picture"},
     {"\x93NUMPY", "an array of NumPy (.npy)"},
     {"\x89HDF", "an HDF5 file"},
     {"%PDF", "a PDF file"},
     {"IESNA", "an IES diagram"}}};

constexpr std::array<Mark, 17> endings{{{".obj", "a Wavefront OBJ mesh"},
                                        {".mtl", "materials of a Wavefront OBJ mesh"},
                                        {".stl", "an STL mesh"},
                                        {".fbx", "an FBX scene"},
                                        {".blend", "a Blender file"},
                                        {".dae", "a COLLADA scene"},
                                        {".usd", "a USD scene"},
                                        {".usda", "a USD scene"},
                                        {".usdc", "a USD scene"},
                                        {".3ds", "a 3DS scene"},
                                        {".step", "a STEP model"},
                                        {".stp", "a STEP model"},
                                        {".ply", "a PLY mesh"},
                                        {".pcd", "a PCD point cloud"},
                                        {".xls", "a spreadsheet"},
                                        {".ods", "a spreadsheet"},
                                        {".ldt", "an EULUMDAT diagram"}}};

} // namespace

std::string kind_of_file(const std::filesystem::path &file, std::string_view bytes) {
  for (const auto &[mark, kind] : first_bytes)
    if (bytes.starts_with(mark))
      return std::string(kind);
  if (const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
      begin != bytes.npos && bytes[begin] == '{')
    return {}; // JSON, whatever its name
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const auto &[known, kind] : endings)
    if (ending == known)
      return std::string(kind);
  return {};
}

} // namespace pmdsim
