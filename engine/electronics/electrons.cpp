#include "engine/electronics/electrons.h"

#include "engine/electronics/frequency_electrons.h"
#include "engine/model/error.h"
#include "engine/model/instruction_sets.h"
#include "engine/model/stopwatch.h"

#include <algorithm>
#include <atomic>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::ElectronLoops, electron_loops)

namespace pmdsim {
namespace {

// Whole blocks of all instruction sets: a thread's work, of one exposure and of many.
constexpr std::uint32_t pixels_at_once = 96 * 48, pixels_of_many = 6 * 48;
constexpr std::uint32_t many_exposures = 64;
// Of each thread, between which a frame of many exposures may be stopped.
constexpr std::uint32_t parts_at_once = 4;

// All threads at once count the parts from 0 to `parts` - 1. Throws Error: input where some pixels have more
// light than a float can hold.
template <class CountPart>
void count_in_parts(std::uint32_t parts, const CountPart &count_part) {
  std::atomic<bool> are_finite = true;
  tbb::parallel_for(0u, parts, [&](std::uint32_t part) {
    if (!count_part(part))
      are_finite = false;
  });
  if (!are_finite)
    throw too_much_light();
}

// Pixels from `first` to `last` - 1.
void count_pixels(const ElectronLoops &loops, const ElectronWork &work, std::uint32_t first,
                  std::uint32_t last, std::uint32_t of_part) {
  count_in_parts((last - first + of_part - 1) / of_part, [&](std::uint32_t part) {
    const std::uint32_t begin = first + part * of_part;
    return loops.count(work, begin, std::min(begin + of_part, last));
  });
}

void count_frame(const ElectronLoops &loops, const ElectronWork &work, std::uint32_t pixels,
                 const std::function<void()> &between) {
  const bool are_many = work.exposures > many_exposures;
  const std::uint32_t of_part = are_many ? pixels_of_many : pixels_at_once;
  const auto threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
  const std::uint32_t at_once = are_many ? parts_at_once * threads * of_part : pixels;
  for (std::uint32_t first = 0; first < pixels; first += at_once) {
    count_pixels(loops, work, first, std::min(first + at_once, pixels), of_part);
    if (between)
      between();
  }
}

// The camera computes its distances in float: of pixels from `first` to `last` - 1 there is no more to tell.
void widen_distances(std::uint32_t first, std::uint32_t last, Return &of) {
  if (!of.unrounded_distance_m.empty())
    std::copy(of.distance_m.begin() + first, of.distance_m.begin() + last,
              of.unrounded_distance_m.begin() + first);
}

// Row by row, unless the strip's rows are the frame's.
void count_strip(const ElectronLoops &loops, ElectronWork work, const StripLight &light,
                 std::uint32_t frame_columns) {
  const auto first_of = [&](std::uint32_t row) { return (light.row + row) * frame_columns + light.column; };
  work.first_of_pairs = first_of(0);
  if (light.columns == frame_columns)
    return count_pixels(loops, work, first_of(0), first_of(light.rows), pixels_at_once);
  count_in_parts(light.rows, [&](std::uint32_t row) {
    ElectronWork of_row = work;
    of_row.first_of_pairs = first_of(row) - row * light.columns;
    return loops.count(of_row, first_of(row), first_of(row) + light.columns);
  });
}

} // namespace

void count_electrons(const Sensor &sensor, const ElectronsRequest &request, Measurement &frame) {
  Stopwatch stopwatch;
  const ElectronLoops &loops = widest_electron_loops(request.host_vector_bits);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    FrequencyElectrons electrons(sensor, request.keep_taps, i, frame);
    electrons.set_light(request);
    const auto pixels = static_cast<std::uint32_t>(sensor.pixel_count());
    count_frame(loops, electrons.work(), pixels, request.between);
    widen_distances(0, pixels, frame.returns[i]);
    if (!request.keep_taps)
      frame.returns[i].taps.clear();
  }
  frame.has_electrons = true;
  stopwatch.add_to(frame, "electrons");
}

bool counts_by_strips(const Sensor &sensor) {
  return sensor.electronics && sensor.electronics->readings() <= many_exposures &&
         !sensor.electronics->noiseless_channels && sensor.waveform.kind == Waveform::Kind::sine &&
         sensor.scatter.empty();
}

void count_electrons(const Sensor &sensor, const ElectronsRequest &request, const StripLight &light,
                     Measurement &frame) {
  const ElectronLoops &loops = widest_electron_loops(request.host_vector_bits);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    FrequencyElectrons electrons(sensor, request.keep_taps, i, frame);
    electrons.set_light(light);
    count_strip(loops, electrons.work(), light, sensor.resolution.x);
    for (std::uint32_t row = light.row; row < light.row + light.rows; ++row) {
      const std::uint32_t first = row * sensor.resolution.x + light.column;
      widen_distances(first, first + light.columns, frame.returns[i]);
    }
  }
  frame.has_electrons = true;
}

} // namespace pmdsim
