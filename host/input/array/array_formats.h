#pragma once
// What read_image_arrays() is made of, a format each. All throw Error (input) at `place`.

#include "host/input/array/image_array.h"
#include "host/input/file/input_error.h"

#include <functional>
#include <string_view>
#include <vector>

namespace pmdsim {

inline constexpr std::string_view npy_magic("\x93NUMPY", 6);

// NumPy's array file, versions 1 to 3. Source: NumPy's documentation, numpy.lib.format.
ImageArray npy_array(std::string_view bytes, const Place &place);

// A ZIP archive of NAME.npy, stored or deflated.
ImageArrays npz_arrays(std::string_view bytes, const std::function<bool(std::string_view)> &wanted,
                       const Place &place);

ImageArray png_array(std::string_view bytes, const Place &place);

ImageArray text_array(std::string_view text, const Place &place);

} // namespace pmdsim
