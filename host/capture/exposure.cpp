#include "host/capture/exposure.h"

#include "engine/electronics/electrons.h"
#include "engine/electronics/scatter.h"
#include "engine/lens/view_channels.h"
#include "engine/model/channels.h"
#include "engine/model/error.h"
#include "engine/model/tap_sequence.h"
#include "engine/signal/unwrapping.h"
#include "host/capture/multipath_of_taps.h"
#include "host/capture/progress.h"
#include "host/input/file/input_error.h"

#include <algorithm>
#include <numeric>
#include <system_error>

namespace pmdsim {
namespace {

double share_saturated(const std::vector<std::uint32_t> &taps_of_pixels) {
  const auto full = std::ranges::count_if(taps_of_pixels, [](std::uint32_t taps) { return taps != 0; });
  return taps_of_pixels.empty() ? 0.0
                                : static_cast<double>(full) / static_cast<double>(taps_of_pixels.size());
}

std::size_t exposures_of_frame(const Setup &setup, const Sensor &sensor) {
  return exposes_tap_by_tap(setup, sensor) ? sensor.modulation_hz.size() * sensor.taps : 1;
}

} // namespace

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
  try {
    coming_ = {time_s, std::async(std::launch::async, [this, time_s] { return setup_.at(time_s); })};
  } catch (const std::system_error &) {
    coming_.reset(); // no thread can be started: at() computes it
  }
}

void add_passes(std::vector<PassTime> &sum, const std::vector<PassTime> &passes) {
  for (const PassTime &pass : passes) {
    const auto known = std::ranges::find(sum, pass.name, &PassTime::name);
    if (known == sum.end())
      sum.push_back(pass);
    else
      known->ms += pass.ms;
  }
}

bool exposes_tap_by_tap(const Setup &setup, const Sensor &sensor) {
  return setup.motion && sensor.tap_interval_s > 0.0;
}

bool exposes_any_tap_by_tap(const Setup &setup) {
  return std::ranges::any_of(setup.start.sensors,
                             [&](const Sensor &sensor) { return exposes_tap_by_tap(setup, sensor); });
}

Warning tap_by_tap_warning(const Setup &setup) {
  return input_warning(warning_code("tap-by-tap-exact"), Place{setup.file}, tap_by_tap_is_exact);
}

double samples_of_frame(const Setup &setup, const Sensor &sensor) {
  return static_cast<double>(exposures_of_frame(setup, sensor)) * static_cast<double>(sensor.pixel_count()) *
         sensor.samples * sensor.samples;
}

double samples_of_frame(const Setup &setup) {
  const auto add = [&](double sum, const Sensor &sensor) { return sum + samples_of_frame(setup, sensor); };
  return std::accumulate(setup.start.sensors.begin(), setup.start.sensors.end(), 0.0, add);
}

std::size_t bytes_of_frame(const Sensor &sensor, bool keep_taps, const Bounces &bounces,
                           const WantedChannels &wanted, bool keep_unrounded) {
  const std::size_t frequencies = sensor.modulation_hz.size(), taps = keep_taps ? sensor.taps : 0;
  std::size_t bytes = 0; // of a pixel
  for (const ChannelRow &row : channel_rows) {
    const bool is_twice = keep_unrounded && !std::holds_alternative<std::monostate>(row.unrounded);
    const std::size_t of_channel = sizeof(float) + (is_twice ? sizeof(double) : 0);
    if (wanted.has(row) && has_channel(row, sensor, bounces))
      bytes += of_channel * (is_of_taps(row) ? frequencies * taps : is_of_frequency(row) ? frequencies : 1);
  }
  return bytes * sensor.pixel_count();
}

Measurement measure_tap_by_tap(const Sensor &sensor, double frame_s, const Exposure &expose, bool keep_taps,
                               const AddToExposure &add, const std::function<void()> &between) {
  std::optional<Measurement> frame;
  std::vector<Return> returns;
  bool keeps_unrounded = false;
  BouncesOfTaps bounces(sensor);
  ElectronsRequest electrons{.keep_taps = keep_taps, .between = between};
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    std::vector<std::vector<float>> taps, with_added;
    for (std::size_t k = 0; k < sensor.taps; ++k) {
      const double time_s = tap_time_s(sensor, frame_s, i, k);
      Measurement exposure = expose(i, time_s);
      bounces.add(exposure, i, k);
      keeps_unrounded = !exposure.returns.front().unrounded_distance_m.empty();
      taps.push_back(std::move(exposure.returns.front().taps[k]));
      if (add)
        add(i, k, time_s, exposure, with_added.emplace_back(taps.back()));
      if (sensor.electronics)
        electrons.mean_radiance_of_taps.push_back(exposure.mean_radiance);
      if (frame) {
        frame->frame_ms += exposure.frame_ms;
        add_passes(frame->passes, exposure.passes);
      } else {
        frame = std::move(exposure);
      }
    }
    returns.push_back(return_from_taps(std::move(taps), sensor.modulation_hz[i], true));
    bounces.finish(returns.back(), i);
    if (!keeps_unrounded) {
      returns.back().unrounded_distance_m.clear();
      returns.back().unrounded_direct_distance_m.clear();
    }
    if (add)
      set_from_taps(returns.back(), std::move(with_added), sensor.modulation_hz[i]);
  }
  frame->bounces = bounces.report();
  frame->returns = std::move(returns);
  // Those of the exposures; what they come to together has no bound.
  frame->accuracy.claimed_m = frame->accuracy.claimed_amplitude = std::nullopt;
  if (!sensor.scatter.empty())
    scatter_taps(sensor, electrons.mean_radiance_of_taps, *frame);
  if (sensor.electronics)
    count_electrons(sensor, electrons, *frame);
  if (sensor.unwrap_range_m > 0.0)
    unwrap_distances(sensor, *frame);
  return std::move(*frame);
}

Exposures::Exposures(const Setup &setup, const std::string &device, bool keep_taps, const Accuracy &accuracy,
                     std::uint32_t paths, const WantedChannels &wanted, bool keep_unrounded)
    : Exposures(setup, std::make_shared<Camera>(device), keep_taps, accuracy, paths, wanted, keep_unrounded) {
}

Exposures::Exposures(const Setup &setup, std::shared_ptr<Camera> camera, bool keep_taps,
                     const Accuracy &accuracy, std::uint32_t paths, const WantedChannels &wanted,
                     bool keep_unrounded)
    : setup_(setup), wanted_(wanted), leaves_noiseless_(leaves_noiseless(wanted, setup.start.sensors)),
      keep_taps_(keep_taps && wanted.have_taps()), keep_unrounded_(keep_unrounded), accuracy_(accuracy),
      camera_(std::move(camera)), others_(setup, camera_->wanted(), paths, are_others_asked_for()),
      instants_(setup) {
  camera_->give({.taps = keep_taps_ || exposes_any_tap_by_tap(setup),
                 .unrounded = keep_unrounded,
                 .electrons_at_once = setup.start.others.empty() && !exposes_any_tap_by_tap(setup),
                 .electrons_of_polar = leaves_noiseless_,
                 .paths = paths});
}

bool Exposures::are_others_asked_for() const {
  return std::ranges::any_of(setup_.start.sensors,
                             [&](const Sensor &sensor) { return part(sensor) >= FramePart::light; });
}

// All of a frame whose taps are exposures of their own, but for what its first one tells.
FramePart Exposures::part(const Sensor &sensor) const {
  if (!exposes_tap_by_tap(setup_, sensor))
    return part_of(wanted_, sensor, setup_.bounces, accuracy_);
  const FramePart part = part_of(wanted_, sensor, setup_.bounces, {});
  return part <= FramePart::visibility ? part : FramePart::electrons;
}

const Instant &Exposures::instant_at(double time_s) {
  if (!instants_.holds(time_s))
    prepared_.reset(); // it looks at the scene that goes
  return instants_.at(time_s);
}

void Exposures::prepare(View view, const Accuracy &accuracy) {
  if (!setup_.motion)
    view.time_s = setup_.frames.start_s; // one time is like another
  if (prepared_ == view)
    return;
  prepared_.reset();
  const Instant &instant = instant_at(view.time_s);
  const FramePart part = this->part(instant.sensors[view.sensor]);
  Sensor sensor = reduced_to(wanted_, part, leaves_noiseless_, instant.sensors[view.sensor]);
  if (view.frequency)
    sensor.modulation_hz = {sensor.modulation_hz[*view.frequency]};
  const bool is_in_lens = view.light == Light::in_lens || part == FramePart::truth;
  const std::vector in_lens{monostatic_illuminator(sensor.world_from_camera)};
  const Bounces bounces = part >= FramePart::light ? setup_.bounces : Bounces{};
  // Light in the lens reaches whatever the lens sees; what bounces comes from elsewhere, too.
  const Shadows shadows = is_in_lens && !bounces.any() ? Shadows::off : setup_.shadows;
  camera_->prepare(instant.scene, sensor, is_in_lens ? in_lens : instant.illuminators, setup_.backscatter,
                   shadows, accuracy, bounces);
  if (part >= FramePart::light && others_.reach(sensor))
    others_.prepare(instant, sensor);
  prepared_ = view;
}

// A frame of one exposure, or what the first exposure of a frame tells.
Measurement Exposures::take_at_once(const View &view, const Sensor &sensor, const ExposureNumber &number,
                                    const Progress &progress, const std::optional<double> &next_s) {
  const FramePart part = this->part(sensor);
  prepare(view, view.frequency ? Accuracy{.mode = Mode::exact, .precision = accuracy_.precision} : accuracy_);
  if (next_s)
    instants_.expect(*next_s);
  const auto add = [&](Measurement &measured) { others_.add_to(sensor, view.time_s, progress, measured); };
  const bool is_reached = part >= FramePart::light && others_.reach(sensor);
  const auto added = is_reached ? Camera::AddLight(add) : nullptr;
  const auto with_view = [&](Measurement &&measured) {
    add_view(view.time_s, sensor, measured);
    return std::move(measured);
  };
  if (part == FramePart::electrons)
    return with_view(camera_->measure(progress, number, added));
  Measurement frame = camera_->measure_noiseless(progress, number, added);
  name_light(part, sensor, frame);
  return with_view(std::move(frame));
}

// Adds what the lens and the scene's geometry alone tell, as far as it is wanted, of an instant that is at
// hand.
void Exposures::add_view(double time_s, const Sensor &sensor, Measurement &frame) {
  const auto has_any = [&](std::initializer_list<std::vector<float> Measurement::*> members) {
    return std::ranges::any_of(members, [&](auto member) { return wanted_.has(row_of(member)); });
  };
  if (has_any({&Measurement::ray_x, &Measurement::ray_y, &Measurement::ray_z}))
    add_rays(sensor, keep_unrounded_, frame);
  if (has_any({&Measurement::normal_x, &Measurement::normal_y, &Measurement::normal_z}))
    add_normals(instants_.at(time_s).scene, sensor, keep_unrounded_, frame);
}

TakenFrame Exposures::take(std::size_t sensor, std::uint32_t number, Light light, const Progress &progress,
                           std::optional<double> next_s) {
  const auto attempt = [&] {
    try {
      return take_whole(sensor, number, light, progress, next_s);
    } catch (...) {
      prepared_.reset(); // the simulator may have given up its frame
      throw;
    }
  };
  try {
    return attempt();
  } catch (const Error &error) {
    if (error.code() != ExitCode::device_lost || !loss_.empty())
      throw;
    loss_ = error.what();
    camera_->give_up_device();
    others_.give_up_devices();
  }
  return attempt();
}

TakenFrame Exposures::take_whole(std::size_t sensor, std::uint32_t number, Light light,
                                 const Progress &progress, const std::optional<double> &next_s) {
  const double time_s = setup_.frames.time_s(number);
  TakenFrame frame{instant_at(time_s).sensors[sensor], {}, accuracy_.mode};
  if (!wanted_.are_all()) { // what was left of the frames before
    const std::scoped_lock lock(spare_mutex_);
    camera_->reuse(std::exchange(spare_, {}));
  }
  const bool is_tap_by_tap = exposes_tap_by_tap(setup_, frame.sensor);
  if (is_tap_by_tap && part(frame.sensor) > FramePart::visibility) {
    frame = take_tap_by_tap(sensor, number, light, progress, next_s);
  } else {
    const std::optional<std::size_t> first_tap = is_tap_by_tap ? std::optional<std::size_t>(0) : std::nullopt;
    if (is_tap_by_tap)
      frame.mode = Mode::exact;
    frame.measurement = take_at_once({sensor, first_tap, time_s, light}, frame.sensor,
                                     {static_cast<std::uint32_t>(sensor), number, 0}, progress, next_s);
  }
  if (!keep_taps_)
    for (Return &of : frame.measurement.returns)
      for (auto *taps : {&of.taps, &of.tap_a_e, &of.tap_b_e, &of.tap_a_dn, &of.tap_b_dn})
        taps->clear();
  for (Return &of : frame.measurement.returns)
    of.share_saturated = frame.measurement.has_electrons ? share_saturated(of.saturated) : 0.0;
  leave_unwanted(frame.measurement);
  return frame;
}

void Exposures::leave_unwanted(Measurement &frame) {
  if (wanted_.are_all())
    return;
  const std::scoped_lock lock(spare_mutex_);
  move_unwanted(wanted_, frame, spare_);
}

void Exposures::reuse(Measurement &&frame) {
  if (wanted_.are_all())
    return camera_->reuse(std::move(frame));
  const std::scoped_lock lock(spare_mutex_);
  move_missing(frame, spare_);
}

std::vector<glm::vec3> Exposures::normals_of(const TakenFrame &frame, double time_s) {
  const auto of = [&](const Scene &scene) {
    return seen_normals_in_world(scene, frame.measurement.triangle_id, frame.sensor.world_from_camera);
  };
  // After taps that are exposures of their own the scene is that of the last of them.
  return instants_.holds(time_s) ? of(instants_.at(time_s).scene) : of(setup_.at(time_s).scene);
}

std::shared_ptr<const TakenFrame> Exposures::share(TakenFrame &&frame) {
  const auto give_back = [this](TakenFrame *held) {
    const std::unique_ptr<TakenFrame> owned(held);
    reuse(std::move(owned->measurement));
  };
  return {std::make_unique<TakenFrame>(std::move(frame)).release(), give_back};
}

TakenFrame Exposures::take_tap_by_tap(std::size_t sensor, std::uint32_t number, Light light,
                                      const Progress &progress, const std::optional<double> &next_s) {
  const double time_s = setup_.frames.time_s(number);
  TakenFrame frame{instant_at(time_s).sensors[sensor], {}, Mode::exact};
  const std::size_t exposures = exposures_of_frame(setup_, frame.sensor), taps = frame.sensor.taps;
  std::uint32_t done = 0;
  const auto expose = [&](std::size_t frequency, double exposure_s) {
    prepare({sensor, frequency, exposure_s, light}, {.mode = Mode::exact, .precision = accuracy_.precision});
    const std::uint32_t before = done++;
    if (done < exposures)
      instants_.expect(tap_time_s(frame.sensor, time_s, done / taps, done % taps));
    else if (next_s)
      instants_.expect(*next_s);
    const auto of_exposure = [&](double fraction) {
      progress((before + fraction) / static_cast<double>(exposures));
    };
    Measurement exposure =
        camera_->measure_light(of_exposure, {static_cast<std::uint32_t>(sensor), number, before});
    if (before == 0)
      add_view(exposure_s, frame.sensor, exposure);
    return exposure;
  };
  const auto add = [&](std::size_t frequency, std::size_t tap, double exposure_s, Measurement &exposure,
                       std::vector<float> &correlation) {
    others_.add_to(frame.sensor, frequency, tap, exposure_s, progress, exposure, correlation);
  };
  const Sensor sensor_of_taps = reduced_to(wanted_, FramePart::electrons, leaves_noiseless_, frame.sensor);
  frame.measurement =
      measure_tap_by_tap(sensor_of_taps, time_s, expose, keep_taps_,
                         others_.reach(frame.sensor) ? AddToExposure(add) : nullptr, [&] { progress(1.0); });
  return frame;
}

} // namespace pmdsim
