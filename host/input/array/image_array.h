#pragma once
// Images of numbers from whatever holds them: NPY, NPZ, EXR, HDF5, PNG, or rows of numbers as text. Files are
// untrusted.

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

struct ImageArray {
  std::string name;             // that it has in a file of several; else ""
  glm::uvec2 resolution{0, 0};  // columns, rows
  std::vector<double> values{}; // row-major, row 0 at the top; NaN and infinity as they are
  bool whole_numbers = false;   // of an integer type, which cannot say that there is none
  double largest = 0.0;         // of an unsigned integer type, its largest number; of others 0
};

struct ImageArrays {
  std::string format;               // "NPY", "NPZ", "EXR or HDF5", "PNG", "text"
  std::vector<ImageArray> arrays{}; // those that are wanted
  std::vector<std::string> names{}; // of all in a file of several; else none
};

// A file of at most 4 GiB, whose first bytes tell what it is; what is none of these is text. NPY and NPZ:
// two-dimensional, of integers of up to 32 bits or floats of 32 or 64, either order of bytes and of axes.
// PNG: grey. Text: rows of equally many numbers, separated by commas, semicolons or blanks; `nan` is one, and
// so is nothing between commas or semicolons; lines that begin with # are left out, and so is a first one of
// names. Of a file of several arrays those are read whose names `wanted`
// takes. Throws Error (input) that names the file, and the line of a text.
ImageArrays read_image_arrays(const std::filesystem::path &file,
                              const std::function<bool(std::string_view name)> &wanted);

} // namespace pmdsim
