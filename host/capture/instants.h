#pragma once
// What there is at the times that frames are taken, each computed while the one before is measured.

#include "host/input/setup/setup.h"

#include <future>
#include <optional>

namespace pmdsim {

// Of a setup, which must outlive it. Where something moves it holds two scenes: that of the last time and
// that of the next.
class Instants {
public:
  explicit Instants(const Setup &setup) : setup_(setup) {}

  // Valid until the next call with another time; of any time alike where nothing moves. Throws Error (input).
  const Instant &at(double time_s);
  // Whether at(time_s) gives what the last call gave.
  bool holds(double time_s) const { return !setup_.motion || (now_ && now_->time_s == time_s); }

  // Begins to compute the instant on another thread: at() will be asked for it next.
  void expect(double time_s);

private:
  struct Moved {
    double time_s;
    Instant instant;
  };
  struct Coming {
    double time_s;
    std::future<Instant> instant;
  };

  const Setup &setup_;
  std::optional<Moved> now_;
  std::optional<Coming> coming_;
};

} // namespace pmdsim
