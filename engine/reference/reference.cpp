#include "engine/reference/reference.h"

#include "engine/reference/bounce/indirect_return.h"
#include "engine/reference/bounce/path_tracer.h"
#include "engine/reference/for_each_block.h"
#include "engine/reference/light/light_paths.h"
#include "engine/reference/shadow/shadow_caster.h"
#include "engine/reference/signal/channels.h"
#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/lens_model.h"
#include "engine/reference/view/ray_caster.h"
#include "engine/reference/view/surface_colours.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

namespace pmdsim::reference {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t default_paths = 1024;

std::vector<Light> lights_in_camera(const std::vector<Illuminator> &illuminators, const Sensor &sensor) {
  std::vector<Light> lights;
  lights.reserve(illuminators.size());
  for (const Illuminator &illuminator : illuminators)
    lights.push_back({diodes_in_camera(illuminator, sensor),
                      std::remainder(illuminator.modulation_phase_rad / (2.0 * std::numbers::pi), 1.0),
                      illuminator.modulation_depth});
  return lights;
}

DiodeSet all_of(std::size_t diodes) {
  DiodeSet all(diodes);
  for (std::size_t diode = 0; diode < diodes; ++diode)
    all.add(diode);
  return all;
}

// The sensor with the shape of the frame that is asked for.
Sensor with_pixels(Sensor sensor, const std::vector<std::uint32_t> &pixels) {
  if (!pixels.empty())
    sensor.resolution = {1, static_cast<std::uint32_t>(pixels.size())};
  return sensor;
}

// One frame being computed: everything that the threads read, and the frame that each fills a row at a time.
class FrameJob {
public:
  FrameJob(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
           Backscatter backscatter, const Options &options)
      : scene_(scene), sensor_(sensor), pixels_(options.pixels), backscatter_(backscatter), lens_(sensor),
        lights_(lights_in_camera(illuminators, sensor)),
        caster_(triangles_in_camera(scene, sensor), discs_in_camera(scene, sensor),
                std::bind_front(is_there, std::cref(scene))),
        every_diode_(all_of(diode_count(illuminators))),
        paths_(options.paths > 0 ? options.paths : default_paths),
        frame_(dark_frame(with_pixels(sensor, options.pixels), options.bounces)) {
    if (options.bounces.any())
      tracer_.emplace(scene, caster_.triangles(), lights_, options.shadows, options.bounces);
    if (options.keep_points)
      frame_.sample_points.resize(frame_.sample_triangle_id.size());
    if (options.shadows == Shadows::off)
      return;
    shadows_.emplace(caster_.triangles(), caster_.discs(), lights_,
                     glm::length(sensor.world_from_camera.translation_m),
                     std::bind_front(is_there, std::cref(scene)));
    frame_.lit = frame_.coverage; // 0
    if (options.keep_visibility)
      frame_.sample_visibility.assign(frame_.sample_triangle_id.size() * every_diode_.words().size(), 0);
  }

  std::size_t blocks() const { return (pixel_count() + block_size - 1) / block_size; }

  void compute_block(std::size_t block) {
    const std::size_t end = std::min((block + 1) * block_size, pixel_count());
    for (std::size_t i = block * block_size; i < end; ++i)
      compute_pixel({i % frame_.resolution.x, i / frame_.resolution.x});
  }

  Frame take() { return std::move(frame_); }

private:
  // Pixels. A row of many samples and diodes takes seconds, for which an interruption would wait.
  static constexpr std::size_t block_size = 16;

  std::size_t pixel_count() const { return std::size_t{frame_.resolution.x} * frame_.resolution.y; }

  // The sensor's pixel at a place of the frame.
  glm::uvec2 sensor_pixel(const glm::uvec2 &place) const {
    if (pixels_.empty())
      return place;
    const std::uint32_t pixel = pixels_[place.y];
    return {pixel % sensor_.resolution.x, pixel / sensor_.resolution.x};
  }

  // `place` is the pixel's in the frame.
  void compute_pixel(const glm::uvec2 &place) {
    const glm::uvec2 pixel = sensor_pixel(place);
    PixelSums sums(sensor_);
    std::vector<std::optional<SurfacePoint>> seen;
    for (std::uint32_t k_row = 0; k_row < sensor_.samples; ++k_row)
      for (std::uint32_t k_column = 0; k_column < sensor_.samples; ++k_column) {
        const glm::uvec2 k(k_column, k_row);
        seen.push_back(
            add_sample(sums, pixel * sensor_.samples + k, sample_index(place * sensor_.samples + k)));
      }
    const std::size_t index = std::size_t{place.y} * frame_.resolution.x + place.x;
    const auto indirect =
        tracer_ ? indirect_returns(sensor_, *tracer_, seen, pixel.y * sensor_.resolution.x + pixel.x, paths_)
                : std::vector<IndirectReturn>();
    set_channels(frame_, index, sums, sensor_.samples * sensor_.samples, indirect);
    if (shadows_ && sums.hits > 0)
      frame_.lit[index] =
          static_cast<double>(sums.reached) / static_cast<double>(sums.hits * every_diode_.count());

    const std::uint32_t nearest_to_centre = (sensor_.samples - 1) / 2;
    const std::uint32_t id =
        frame_.sample_triangle_id[sample_index(place * sensor_.samples + nearest_to_centre)];
    frame_.triangle_id[index] = id;
    frame_.object_id[index] = id == no_id ? no_id : scene_.object_of(id);
  }

  // `sample` is one of the sensor's, `index` its own in the frame. Returns what it sees.
  std::optional<SurfacePoint> add_sample(PixelSums &sums, const glm::uvec2 &sample, std::size_t index) {
    const auto direction = lens_.sample_ray(sample);
    if (!direction)
      return std::nullopt;
    const auto hit = caster_.nearest(*direction);
    if (!hit)
      return std::nullopt;
    frame_.sample_triangle_id[index] = hit->id;
    const SurfacePoint point = surface_point(*direction, *hit);
    ++sums.hits;
    sums.range_m.add(hit->range_m);
    sums.z_m.add(point.position_m.z);
    const DiodeSet reached = shadows_ ? shadows_->reached(point, hit->id) : every_diode_;
    sums.reached += reached.count();
    keep_visibility(index, reached);
    if (!frame_.sample_points.empty())
      frame_.sample_points[index] = point;
    const auto paths = light_paths(point, lights_, reached, backscatter_);
    for (ReturnSum &sum : sums.returns)
      sum.add(paths);
    return point;
  }

  void keep_visibility(std::size_t sample, const DiodeSet &reached) {
    if (frame_.sample_visibility.empty())
      return;
    const auto &words = reached.words();
    const auto first = static_cast<std::ptrdiff_t>(sample * words.size());
    std::copy(words.begin(), words.end(), frame_.sample_visibility.begin() + first);
  }

  SurfacePoint surface_point(const glm::dvec3 &direction, const Hit &hit) const {
    return {hit.range_m * direction, caster_.normal(direction, hit.id),
            reflectivity(scene_, hit.id, caster_.weights(direction, hit.id)),
            lens_.vignetting_gain(direction)};
  }

  // `sample` counts the frame's rows and columns of samples.
  std::size_t sample_index(const glm::uvec2 &sample) const {
    return std::size_t{sample.y} * sensor_.samples * frame_.resolution.x + sample.x;
  }

  const Scene &scene_;
  const Sensor &sensor_;
  const std::vector<std::uint32_t> &pixels_; // none: all
  Backscatter backscatter_;
  LensModel lens_;
  std::vector<Light> lights_;
  RayCaster caster_;
  DiodeSet every_diode_;
  std::optional<ShadowCaster> shadows_;
  std::optional<PathTracer> tracer_; // nothing without bounces
  std::uint32_t paths_;              // of a pixel
  Frame frame_;
};

} // namespace

Frame simulate(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
               Backscatter backscatter, const Options &options, const std::function<void(double)> &progress) {
  if (options.bounces.any() && backscatter != Backscatter::lambert)
    throw std::logic_error("reference: light bounces by Backscatter::lambert only");
  const auto start = Clock::now();
  FrameJob job(scene, sensor, illuminators, backscatter, options);
  for_each_block(
      job.blocks(), [&](std::size_t block) { job.compute_block(block); }, progress);
  Frame frame = job.take();
  frame.frame_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return frame;
}

} // namespace pmdsim::reference
