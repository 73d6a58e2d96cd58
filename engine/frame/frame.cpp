#include "engine/frame/frame.h"

#include "engine/error_budget/budget.h"
#include "engine/shadow/visibility_bits.h"
#include "engine/vulkan/commands.h"

#include <algorithm>
#include <chrono>
#include <variant>

namespace pmdsim {
Frame::Frame(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request,
             std::uint32_t attempt, TextureCache &textures, SpareMemory &&spare)
    : options_(options), shadows_(request.shadows), accuracy_(request.accuracy),
      on_(make_passes(device, options, request, attempt, textures, std::move(spare))),
      check_graph_(ids | points | visibility_bits | visibility_counts) {
  list_view();
  if (on_.shadow)
    list_shadows(graph_);
  if (on_.shadow && options_.keep_reached)
    list_reached();
  if (on_.all) {
    list_sum(graph_, on_.all->sum, on_.windows, nullptr);
    list_resolve(graph_, on_.all->resolve, nullptr);
  }
  if (on_.sorted)
    list_sorting();
  if (on_.unshadowed)
    list_class(*on_.unshadowed, on_.sorted->lists.of(shader::list_lit), {0, on_.unshadowed->sum.runs(), 0});
  if (on_.rest)
    list_class(*on_.rest, on_.sorted->lists.of(shader::list_rest), on_.windows.front());
  list_read_back();
  if (on_.check)
    list_check();
}

// What each sample sees, and where.
void Frame::list_view() {
  graph_.add_before(
      {.name = "visibility", .reads = no_resource, .writes = ids, .record = [&](const Recording &at) {
         on_.raster.record(at.commands, at.planned, on_.scene, drawn_tags(on_.buffers));
       }});
  if (const auto *search = std::get_if<SearchPass>(&on_.points))
    graph_.add_before(
        {.name = "points", .reads = ids, .writes = ids | points, .record = [=, this](const Recording &at) {
           search->record(at.commands, at.planned, on_.buffers, on_.scene);
         }});
  if (const auto *pass = std::get_if<PointsPass>(&on_.points))
    graph_.add_before(
        {.name = "points", .reads = ids, .writes = points, .record = [=, this](const Recording &at) {
           pass->record(at.commands, at.of_strip(), on_.buffers, on_.scene);
         }});
}

// Which sources reach which sample.
void Frame::list_shadows(FrameGraph &graph) {
  const bool of_check = &graph == &check_graph_; // which finds the tiles of the frame
  graph.add_to_window({.name = "lit",
                       .reads = ids | points,
                       .writes = visibility_bits | visibility_counts,
                       .record = [=, this](const Recording &at) {
                         if (at.window == 0 && !of_check)
                           on_.shadow->record_tiles(at.commands, at.of_strip(), on_.buffers);
                         on_.shadow->record(at.commands, at.of_strip(), on_.buffers, at.window);
                       }});
}

// Their bits for the host.
void Frame::list_reached() {
  graph_.add_to_window({.name = "read_back",
                        .reads = visibility_bits,
                        .writes = no_resource,
                        .record =
                            [&](const Recording &at) {
                              record_reached(at.commands, at.of_strip(), on_.buffers, on_.windows[at.window]);
                            },
                        .store =
                            [&](const Recording &at, Measurement &to) {
                              store_reached(at.of_strip(), on_.buffers, on_.windows[at.window], on_.groups,
                                            to.sample_reached);
                            }});
}

// The sum over the sources of all pixels, window by window of visibility bits, or of a list of pixels.
void Frame::list_sum(FrameGraph &graph, const AccumulatePass &pass, const std::vector<LitWindow> &windows,
                     const vulkan::Buffer *list) {
  const Resources shadows = on_.shadow ? visibility_bits : no_resource;
  const Resources samples = on_.path.record == SampleRecord::depth ? ids : ids | points;
  Pass sum{.name = "accumulate",
           .reads = samples | shadows | (list ? pixel_lists : no_resource),
           .writes = sums | terms,
           .record =
               [=, &pass, this](const Recording &at) {
                 pass.record(at.commands, at.of_strip(), on_.buffers, on_.scene, windows[at.window],
                             at.parts.first, at.parts.last, list);
               },
           .parts =
               [=](std::size_t window) {
                 return Parts{windows[window].first_run, windows[window].last_run};
               },
           .all_parts = pass.runs(),
           .interactions = [&pass](const shader::Strip &strip) { return pass.interactions_per_run(strip); },
           .list = list};
  if (list && &graph == &graph_)
    graph.add_after(std::move(sum));
  else
    graph.add_to_window(std::move(sum));
}

void Frame::list_resolve(FrameGraph &graph, const ResolvePass &pass, const vulkan::Buffer *list) {
  const Resources shadows = on_.shadow ? visibility_counts : no_resource;
  graph.add_after({.name = "resolve",
                   .reads = ids | sums | terms | shadows | (list ? pixel_lists : no_resource),
                   .writes = channels,
                   .record =
                       [=, &pass, this](const Recording &at) {
                         pass.record(at.commands, at.of_strip(), on_.buffers, on_.scene, list);
                       },
                   .list = list});
}

// Sorts the pixels into classes, and sums those whose light is uniform.
void Frame::list_sorting() {
  const SortedPasses &sorted = *on_.sorted;
  const auto samples = [](const Recording &at) { return at.of_strip().samples * at.of_strip().samples; };
  const Resources shadows = on_.shadow ? visibility_counts : no_resource;
  graph_.add_after({.name = "short_way",
                    .reads = ids | shadows,
                    .writes = channels | pixel_lists,
                    .record = [=, &sorted, this](const Recording &at) {
                      sorted.lists.record_clear(at.commands);
                      sorted.uniform.record(at.commands, at.of_strip(), on_.buffers, on_.scene);
                      sorted.lists.record_count(at.commands, samples(at));
                    }});
  if (!sorted.refined)
    return;
  const vulkan::Buffer &few = sorted.lists.of(shader::list_few);
  graph_.add_after({.name = "short_way",
                    .reads = ids | shadows | pixel_lists,
                    .writes = channels | pixel_lists,
                    .record =
                        [=, &sorted, &few, this](const Recording &at) {
                          sorted.refined->record(at.commands, at.of_strip(), on_.buffers, on_.scene, &few);
                          sorted.lists.record_count(at.commands, samples(at));
                        },
                    .list = &few});
}

// A class of pixels that sorting has listed.
void Frame::list_class(const ClassPasses &passes, const vulkan::Buffer &list, const LitWindow &window) {
  if (const auto &pass = on_.sorted->points)
    graph_.add_after({.name = "points",
                      .reads = ids | pixel_lists,
                      .writes = points,
                      .record =
                          [&](const Recording &at) {
                            pass->record(at.commands, at.of_strip(), on_.buffers, on_.scene, &list);
                          },
                      .list = &list});
  list_sum(graph_, passes.sum, {window}, &list);
  list_resolve(graph_, passes.resolve, &list);
}

void Frame::list_read_back() {
  graph_.add_after({.name = "read_back",
                    .reads = ids | channels,
                    .writes = no_resource,
                    .record =
                        [&](const Recording &at) {
                          record_read_back(at.commands, at.of_strip(), on_.buffers, on_.signal, on_.truth);
                        },
                    .store =
                        [&](const Recording &at, Measurement &to) {
                          store_strip(at.of_strip(), on_.buffers, on_.sensor, on_.signal, on_.truth, to);
                        }});
}

// Some pixels of a strip again, with every sample and source. The bits of the last window are there still.
void Frame::list_check() {
  const ExactCheck &check = *on_.check;
  const auto windows = on_.shadow ? on_.windows : std::vector{all_runs(check.groups())};
  check_graph_.add_before(
      {.name = "points", .reads = ids, .writes = points | pixel_lists, .record = [&](const Recording &at) {
         check.record_points(at.commands, at.strip, at.planned, on_.buffers, on_.scene);
       }});
  if (on_.shadow && windows.size() > 1)
    list_shadows(check_graph_);
  list_sum(check_graph_, check.sum(), windows, &check.list());
  list_resolve(check_graph_, check.resolve(), &check.list());
  check_graph_.add_after(
      {.name = "read_back", .reads = channels, .writes = no_resource, .record = [&](const Recording &at) {
         record_read_back(at.commands, at.of_strip(), on_.buffers, on_.signal, on_.truth);
       }});
}

void Frame::warm_up(vulkan::PassRecorder &recorder) const {
  graph_.warm_up(recorder, on_.strips.front(), on_.windows.size());
}

void Frame::forget_broken(vulkan::PassRecorder &recorder) const {
  recorder.begin();
  recorder.commands().fillBuffer(on_.buffers.broken.get(), 0, sizeof(shader::BrokenPromise), 0);
  recorder.finish();
}

// What is left to the host: frames in which nothing stands in any light, and samples that see nothing.
void Frame::finish_visibility(Measurement &measurement) const {
  if (!on_.shadow) {
    measurement.lit.resize(measurement.coverage.size());
    std::ranges::transform(measurement.coverage, measurement.lit.begin(),
                           [](float coverage) { return coverage > 0.0f ? 1.0f : 0.0f; });
    all_reached(on_.groups, measurement.sample_reached);
  }
  if (!measurement.sample_reached.empty())
    clear_unseen(measurement);
}

void Frame::check_strip(vulkan::PassRecorder &recorder, std::size_t strip, Measurement &measurement) const {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<PassTime> times = recorder.times();
  const PlannedStrip &planned = on_.strips[strip];
  const std::size_t windows = on_.shadow ? on_.windows.size() : 1;
  check_graph_.run(recorder, planned, strip, windows, {}, measurement);
  recorder.reset(times);
  on_.check->compare(strip, planned, on_.buffers, measurement, measurement.accuracy);
  measurement.accuracy.check_ms += vulkan::milliseconds_since(start);
}

Measurement Frame::measure(vulkan::PassRecorder &recorder, Measurement &&memory,
                           const std::function<void(double)> &progress) const {
  const auto start = std::chrono::steady_clock::now();
  recorder.reset();
  Measurement measurement = make_measurement(on_.sensor, on_.signal, options_, std::move(memory));
  const double memory_ms =
      vulkan::milliseconds_since(start); // of a first frame, to which the system gives it
  measurement.accuracy = on_.report;
  const bool shaded = shadows_ == Shadows::automatic;
  if (!shaded)
    measurement.lit.clear();
  else if (options_.keep_reached)
    measurement.sample_reached = none_reached(on_.sensor, on_.groups);
  if (on_.signal.promised)
    forget_broken(recorder);
  for (std::size_t i = 0; i < on_.strips.size(); ++i) {
    const auto of_strip = [&](double fraction) {
      if (progress)
        progress((static_cast<double>(i) + fraction) / static_cast<double>(on_.strips.size()));
    };
    graph_.run(recorder, on_.strips[i], i, on_.windows.size(), of_strip, measurement);
    of_strip(1.0);
    if (on_.check)
      check_strip(recorder, i, measurement);
  }
  if (shaded)
    finish_visibility(measurement);
  recorder.add("read_back", memory_ms);
  measurement.passes = recorder.times();
  measurement.frame_ms = vulkan::milliseconds_since(start) - measurement.accuracy.check_ms;
  return measurement;
}

std::optional<std::string> Frame::violation(const Measurement &measured) const {
  if (accuracy_.mode == Mode::exact)
    return std::nullopt;
  return promise_breach(broken_promise(on_.buffers), measured.accuracy, accuracy_, on_.sensor.ambiguity_m());
}

} // namespace pmdsim
