#include "host/hdf5/hdf5.h"

#include <algorithm>

namespace pmdsim {
namespace {

std::mutex &hdf5_mutex() {
  static std::mutex mutex;
  return mutex;
}

} // namespace

Hdf5Turn::Hdf5Turn() : alone_(hdf5_mutex()) {
  H5open();
  H5Eget_auto2(H5E_DEFAULT, &print_, &print_to_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Turn::~Hdf5Turn() {
  H5Eclear2(H5E_DEFAULT);
  H5Eset_auto2(H5E_DEFAULT, print_, print_to_);
}

Hdf5Reason hdf5_reason() {
  Hdf5Reason reason;
  const auto keep = [](unsigned, const H5E_error2_t *error, void *to) -> herr_t {
    auto &kept = *static_cast<Hdf5Reason *>(to);
    if (error->desc)
      kept.text = error->desc;
    // Version 1.10 also calls a lack of space what is one of bytes in the file.
    const bool is_of_file = kept.text.starts_with("ran off the end of the buffer");
    kept.lacks_memory =
        kept.lacks_memory || (error->maj_num == H5E_RESOURCE && error->min_num == H5E_NOSPACE && !is_of_file);
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &reason); // the last one is the innermost
  std::ranges::replace(reason.text, '\n', ' ');
  if (reason.text.empty()) // it has no memory for one
    return {"HDF5 gives no reason", true};
  reason.text.insert(0, "HDF5: ");
  return reason;
}

} // namespace pmdsim
