#include "host/report/memory_forecast.h"

#include "engine/model/channels.h"
#include "host/memory/byte_count.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace pmdsim {
namespace {

// Bytes as they were measured with lavapipe on x86-64 (tests/whole/extremes/memory_test.cpp compares).
constexpr std::uint64_t writing_bytes = 50'000'000;   // pictures and what is compressed, of any frame
constexpr std::uint64_t reference_bytes = 20'000'000; // Embree and its threads
constexpr std::uint64_t bytes_of_shape = 150, bytes_of_vertex = 60; // in all tables of the passes
constexpr std::uint64_t bytes_of_shape_in_light = 100, bytes_of_vertex_in_light = 260; // more, with shadows
constexpr std::uint64_t bytes_of_shape_in_tree = 400;                                  // the reference's
constexpr std::uint64_t bytes_of_diode = 2'000;
constexpr std::uint64_t usual_strip_samples = 1u << 20;
// Of a strip: of a sample whose pixel is made of its depth, and of any other, whose point is kept.
constexpr std::uint64_t bytes_of_depth_sample = 20, bytes_of_point_sample = 140;
constexpr std::uint64_t bytes_of_lit_sample = 40; // more, with shadows
constexpr std::uint64_t bytes_of_sum = 16;        // of each frequency and harmonic of a sample
constexpr std::uint64_t most_of_buffer = std::uint64_t{1} << 27;
constexpr std::uint64_t bytes_of_sample_ids = 8;      // of every sample, where light bounces
constexpr std::uint64_t instants_at_once = 2;         // beside the first
constexpr std::uint64_t bytes_of_bounced_pixel = 100; // of each tone
constexpr std::uint64_t bytes_of_reference_pixel = 400;
constexpr std::uint64_t bytes_of_element_pair = 14; // of each tone, of elements that may be cut finer
constexpr std::uint64_t moving_bytes = 25'000'000;  // passes that are compiled for other instants

std::uint64_t samples_of(const Sensor &sensor) {
  return std::uint64_t{sensor.pixel_count()} * sensor.samples * sensor.samples;
}

std::uint64_t sums_of(const Sensor &sensor) {
  const std::uint64_t harmonics = sensor.waveform.kind == Waveform::Kind::sine ? 1 : sensor.taps;
  return sensor.modulation_hz.size() * harmonics;
}

std::uint64_t scene_bytes(const FrameToForecast &frame, bool is_lit) {
  const std::uint64_t shapes = frame.scene.shape_count(), vertices = frame.scene.positions_m.size();
  std::uint64_t bytes = shapes * (bytes_of_shape + (is_lit ? bytes_of_shape_in_light : 0)) +
                        vertices * (bytes_of_vertex + (is_lit ? bytes_of_vertex_in_light : 0));
  for (const Surface &surface : frame.scene.surfaces)
    if (surface.paint && surface.paint->texture)
      bytes += surface.paint->texture->texels.size() * sizeof(glm::vec4);
  return bytes;
}

// Whether pixels are made of depths at once, of which less is kept.
bool keeps_depths(const Sensor &sensor) {
  return sensor.samples == 1 && sensor.waveform.kind == Waveform::Kind::sine && !sensor.has_distortion();
}

std::uint64_t strip_bytes(const FrameToForecast &frame, bool is_lit) {
  const Sensor &sensor = frame.sensor;
  const std::uint64_t most = frame.max_strip_samples > 0 ? frame.max_strip_samples : usual_strip_samples;
  const std::uint64_t samples = std::min(samples_of(sensor), most);
  const std::uint64_t of_sample = (keeps_depths(sensor) ? bytes_of_depth_sample : bytes_of_point_sample) +
                                  (is_lit ? bytes_of_lit_sample : 0);
  const std::uint64_t sums =
      keeps_depths(sensor) ? 0 : std::min(samples * sums_of(sensor) * bytes_of_sum, most_of_buffer);
  const std::uint64_t pixels = samples / (std::uint64_t{sensor.samples} * sensor.samples) + 1;
  const std::uint64_t channels = std::min(pixels * frame.frame_bytes / sensor.pixel_count(), most_of_buffer);
  return samples * of_sample + sums + channels;
}

std::uint64_t geometry_bytes(const Scene &scene) {
  return scene.positions_m.capacity() * sizeof(glm::dvec3) + scene.triangles.capacity() * sizeof(Triangle) +
         scene.discs.capacity() * sizeof(Disc) + scene.texture_coordinates.capacity() * sizeof(glm::dvec2) +
         scene.colours.capacity() * sizeof(glm::vec4);
}

// What elements see of each other.
std::uint64_t exchange_bytes(const FrameToForecast &frame) {
  return frame.elements * frame.elements * bytes_of_element_pair * sums_of(frame.sensor);
}

std::uint64_t diodes_of(const std::vector<Illuminator> &illuminators) {
  return std::accumulate(illuminators.begin(), illuminators.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Illuminator &each) { return sum + each.diodes.size(); });
}

void add(std::vector<MemoryPart> &parts, const char *what, std::uint64_t bytes) {
  if (bytes > 0)
    parts.push_back({what, bytes});
}

} // namespace

std::uint64_t MemoryForecast::bytes() const {
  return std::accumulate(parts.begin(), parts.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const MemoryPart &part) { return sum + part.bytes; });
}

const MemoryPart &MemoryForecast::largest() const {
  return *std::ranges::max_element(parts, {}, &MemoryPart::bytes);
}

MemoryForecast forecast_memory(const FrameToForecast &frame) {
  const std::uint64_t samples = samples_of(frame.sensor), pixels = frame.sensor.pixel_count();
  const bool is_lit = frame.scene.shape_count() > 1;
  MemoryForecast forecast;
  if (frame.by == MeasuredBy::reference) {
    add(forecast.parts, "the reference", reference_bytes);
    add(forecast.parts, "the reference's tree over the scene",
        frame.scene.shape_count() * bytes_of_shape_in_tree);
    add(forecast.parts, "the reference's pixels",
        pixels * bytes_of_reference_pixel * frame.sensor.modulation_hz.size());
  } else {
    const bool is_apart = frame.by == MeasuredBy::device_apart;
    add(forecast.parts, "the device's passes",
        bytes_of_device + diodes_of(frame.illuminators) * bytes_of_diode);
    add(forecast.parts, "the scene on the device", scene_bytes(frame, is_lit) / (is_apart ? 2 : 1));
    add(forecast.parts, "a strip of samples", is_apart ? 0 : strip_bytes(frame, is_lit));
  }
  add(forecast.parts, "the frame's channels", frame.frames_at_once * frame.frame_bytes);
  add(forecast.parts, "files while they are written",
      frame.is_written ? frame.made_bytes + writing_bytes : 0);
  if (frame.moves)
    add(forecast.parts, "the scene at other times",
        instants_at_once * geometry_bytes(frame.scene) + moving_bytes);
  if (frame.bounces.any()) {
    add(forecast.parts, "the IDs of all samples",
        frame.sensor.samples > 1 ? samples * bytes_of_sample_ids : 0);
    add(forecast.parts, "light that bounces",
        pixels * sums_of(frame.sensor) * bytes_of_bounced_pixel + exchange_bytes(frame));
  }
  return forecast;
}

Error lacking_memory(const Sensor &sensor, const MemoryForecast &forecast, const std::string &lack) {
  return {
      ExitCode::out_of_memory,
      fmt::format("out of memory: a frame of the sensor {} {}, most of it for {}: take a lower resolution, "
                  "fewer samples or frequencies, or a smaller scene",
                  sensor.name, lack, forecast.largest().what)};
}

std::string memory_text(const MemoryForecast &forecast) {
  std::vector<MemoryPart> parts = forecast.parts;
  std::ranges::stable_sort(parts, std::ranges::greater(), &MemoryPart::bytes);
  std::string text;
  for (const MemoryPart &part : parts)
    text += fmt::format("{}{} for {}", text.empty() ? "" : ", ", byte_text(part.bytes), part.what);
  return text;
}

} // namespace pmdsim
