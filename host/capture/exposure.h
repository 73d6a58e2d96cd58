#pragma once
// A sensor's frame as its camera takes it: in one exposure, or, where the taps are taken one after the other
// and something moves meanwhile, in one for each frequency and tap.

#include "host/capture/camera.h"
#include "host/capture/other_cameras.h"
#include "host/capture/wanted_channels.h"

#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// The scene, sensors and illuminators at the times that frames of a setup, which must outlive it, are taken.
// Each instant is computed while the one before is measured. Where something moves it holds two scenes: that
// of the last time and that of the next.
class Instants {
public:
  explicit Instants(const Setup &setup) : setup_(setup) {}

  // The instant, valid until the next call with another time; the same at any time where nothing moves.
  // Throws Error (input).
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

// The setup's illuminators with its shadows, or light in the sensor's lens (eq. 2 and 3), which casts no
// shadows that the lens sees. Where light bounces, it does with either.
enum class Light { beside_lens, in_lens };

// Whether every tap of the sensor's frames is an exposure of its own.
bool exposes_tap_by_tap(const Setup &setup, const Sensor &sensor);

bool exposes_any_tap_by_tap(const Setup &setup);

// What is told of such frames where an error is asked for.
Warning tap_by_tap_warning(const Setup &setup);
inline constexpr const char *tap_by_tap_is_exact =
    "frames whose taps are taken one after the other are taken in mode exact, and nothing is claimed of "
    "their errors";

// Samples that are measured for one frame, in all its exposures; of one sensor, and of all.
double samples_of_frame(const Setup &setup, const Sensor &sensor);
double samples_of_frame(const Setup &setup);

// Bytes of the wanted channels of one frame, with or without its taps, unrounded distances and what light
// that bounces adds; shadows included, whether or not there are.
std::size_t bytes_of_frame(const Sensor &sensor, bool keep_taps, const Bounces &bounces,
                           const WantedChannels &wanted = {}, bool keep_unrounded = false);

// Times of the same pass add up; a pass that is new comes last.
void add_passes(std::vector<PassTime> &sum, const std::vector<PassTime> &passes);

// Measures one frequency alone at a time, its taps kept, without its electronics.
using Exposure = std::function<Measurement(std::size_t frequency, double time_s)>;

// Adds light from elsewhere to the exposure of one tap: to its mean radiance, and to its correlation samples,
// which are apart.
using AddToExposure = std::function<void(std::size_t frequency, std::size_t tap, double time_s,
                                         Measurement &exposure, std::vector<float> &correlation)>;

// The frame that begins at `frame_s`: tap k of frequency i is that of the exposure at tap_time_s(), and
// phase, amplitude and distance follow from the taps. Ground truth is the first exposure's; times add up. Of
// light that bounces see multipath_of_taps.h. Electronics count the electrons of each exposure's own light;
// `keep_taps` and `between` as ElectronsRequest.
Measurement measure_tap_by_tap(const Sensor &sensor, double frame_s, const Exposure &expose,
                               bool keep_taps = true, const AddToExposure &add = {},
                               const std::function<void()> &between = {});

// One sensor's frame.
struct TakenFrame {
  Sensor sensor; // where it was when the frame began
  Measurement measurement;
  Mode mode = Mode::exact; // that it was taken in
  // Of each pixel's surface, by triangle_id, world frame, turned to the lens; only on request.
  std::vector<glm::vec3> normals{};
  std::vector<Warning> warnings{}; // about it; the place of each is the sensor
};

// Takes frames of a setup, which must outlive it, on one device.
class Exposures {
public:
  // Throws Error (no_device). Without `keep_taps` frames have no taps, however they are taken. Frames whose
  // taps are exposures of their own are taken in mode exact whatever `accuracy` says: a bound of each
  // exposure's error is no bound of the phase and distance that follow from a tap of each.
  // `paths` and `keep_unrounded` as Extras. Of the channels of a frame only those that are wanted are there,
  // and what no other needs is not computed; they have the bits that they have in a whole frame.
  Exposures(const Setup &setup, const std::string &device, bool keep_taps, const Accuracy &accuracy = {},
            std::uint32_t paths = 0, const WantedChannels &wanted = {}, bool keep_unrounded = false);
  // With a camera that others may have used before, and nobody does meanwhile.
  Exposures(const Setup &setup, std::shared_ptr<Camera> camera, bool keep_taps, const Accuracy &accuracy,
            std::uint32_t paths, const WantedChannels &wanted, bool keep_unrounded);

  const Camera &camera() const { return *camera_; }
  // As Simulator::reuse().
  void reuse(Measurement &&frame);
  // A frame whose memory is reused once nobody holds it any more; this must outlive it.
  std::shared_ptr<const TakenFrame> share(TakenFrame &&frame);

  // The frame of that number, of the sensor with the index `sensor`. `next_s`, where it is known, is when the
  // next frame to be taken begins: what has moved by then is computed meanwhile. Where the device is lost, it
  // is set up anew and the frame made again, once in a life. Throws Error, interrupted among others.
  TakenFrame take(std::size_t sensor, std::uint32_t number, Light light, const Progress &progress,
                  std::optional<double> next_s = std::nullopt);

  // Why the device was set up anew; empty: it was not.
  const std::string &loss() const { return loss_; }

  // TakenFrame::normals of a frame that began at that time; none where it has no triangle_id.
  std::vector<glm::vec3> normals_of(const TakenFrame &frame, double time_s);

private:
  // The view that the camera is prepared for, at one frequency alone or at all of them.
  struct View {
    std::size_t sensor;
    std::optional<std::size_t> frequency;
    double time_s;
    Light light;

    bool operator==(const View &) const = default;
  };

  bool are_others_asked_for() const;
  FramePart part(const Sensor &sensor) const;
  const Instant &instant_at(double time_s);
  Measurement take_at_once(const View &view, const Sensor &sensor, const ExposureNumber &number,
                           const Progress &progress, const std::optional<double> &next_s);
  TakenFrame take_whole(std::size_t sensor, std::uint32_t number, Light light, const Progress &progress,
                        const std::optional<double> &next_s);
  TakenFrame take_tap_by_tap(std::size_t sensor, std::uint32_t number, Light light, const Progress &progress,
                             const std::optional<double> &next_s);
  void prepare(View view, const Accuracy &accuracy);
  void add_view(double time_s, const Sensor &sensor, Measurement &frame);
  void leave_unwanted(Measurement &frame);

  const Setup &setup_;
  WantedChannels wanted_;
  bool leaves_noiseless_, keep_taps_, keep_unrounded_;
  Accuracy accuracy_;
  std::shared_ptr<Camera> camera_;
  OtherCameras others_;
  std::optional<View> prepared_;
  std::string loss_;
  Instants instants_;
  std::mutex spare_mutex_;
  Measurement spare_; // memory of channels, where only some are wanted
};

} // namespace pmdsim
