#pragma once
// HDF5's C library as our reader and our writer use it: one thread at a time, and silent.

#include <hdf5.h>
#include <mutex>
#include <string>
#include <utility>

namespace pmdsim {

// While one lives, no other thread is in HDF5 on our account (its dimension scales are not safe for threads,
// whatever the library says of itself), and HDF5 prints no errors. What the process had set comes back.
class Hdf5Turn {
public:
  Hdf5Turn();
  ~Hdf5Turn();
  Hdf5Turn(const Hdf5Turn &) = delete;
  Hdf5Turn &operator=(const Hdf5Turn &) = delete;

private:
  std::scoped_lock<std::mutex> alone_;
  H5E_auto2_t print_ = nullptr;
  void *print_to_ = nullptr;
};

// HDF5 closes nothing when the process ends, which it tells of where a damaged file left something open. To
// be called before anything else of HDF5's, and by programs alone: others may have files open in a library's
// process.
inline void leave_hdf5_open_at_exit() { H5dont_atexit(); }

// What HDF5 says of this thread's last call that failed.
struct Hdf5Reason {
  std::string text; // the innermost reason, in one line
  bool lacks_memory = false;
};
Hdf5Reason hdf5_reason();

// Something of HDF5's that is open, and how it is closed. Below 0: nothing is.
class Hdf5Handle {
public:
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, herr_t (*closed_by)(hid_t)) : id_(id), close_(closed_by) {}
  Hdf5Handle(Hdf5Handle &&other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle &operator=(Hdf5Handle &&other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() {
    if (id_ >= 0)
      close_(id_);
  }

  hid_t id() const { return id_; }
  // Closes it now; what close() says.
  herr_t close() { return close_(std::exchange(id_, -1)); }

private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

} // namespace pmdsim
