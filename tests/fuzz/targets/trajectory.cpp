// Poses over time: TUM, KITTI, EuRoC and CSV.

#include "tests/fuzz/target.h"

#include "host/input/setup/trajectory.h"

using namespace pmdsim;

FUZZ_TARGET(trajectory) {
  const std::filesystem::path file = fuzz::write_file("poses.txt", fuzz::text_of(data, size));
  fuzz::accepts([&] {
    const Trajectory trajectory = read_trajectory(file, Place{"setup.json"} / "pose");
    for (const double time_s : {-1e300, 0.0, 0.5, trajectory.times_s.back(), 1e300})
      static_cast<void>(trajectory.at(time_s));
  });
  return 0;
}
