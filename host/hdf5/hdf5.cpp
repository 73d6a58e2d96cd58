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

std::string hdf5_reason() {
  std::string reason;
  const auto keep = [](unsigned, const H5E_error2_t *error, void *to) -> herr_t {
    if (error->desc)
      *static_cast<std::string *>(to) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &reason); // the last one is the innermost
  std::ranges::replace(reason, '\n', ' ');
  return reason.empty() ? "HDF5 gives no reason" : "HDF5: " + reason;
}

} // namespace pmdsim
