#include "host/capture/instants.h"

#include <utility>

namespace pmdsim {

const Instant &Instants::at(double time_s) {
  if (!setup_.motion)
    return setup_.start;
  if (holds(time_s))
    return now_->instant;
  now_.reset(); // its memory first
  std::optional<Coming> coming = std::exchange(coming_, std::nullopt);
  if (coming && coming->time_s == time_s)
    now_ = {time_s, coming->instant.get()};
  else
    now_ = {time_s, setup_.at(time_s)};
  return now_->instant;
}

void Instants::expect(double time_s) {
  if (holds(time_s) || (coming_ && coming_->time_s == time_s))
    return;
  coming_.reset(); // waits for a thread that computes in vain
  coming_ = {time_s, std::async(std::launch::async, [this, time_s] { return setup_.at(time_s); })};
}

} // namespace pmdsim
