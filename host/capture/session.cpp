#include "host/capture/session.h"

#include "engine/model/error.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::shared_ptr<const Setup> with_samples(const std::shared_ptr<const Setup> &setup,
                                          const std::optional<SampleChoice> &samples) {
  if (!samples)
    return setup;
  auto changed = std::make_shared<Setup>(*setup);
  set_samples(*changed, *samples);
  return changed;
}

} // namespace

void Session::load(SetupDocument document, std::shared_ptr<const Scene> scene) {
  SetupLoader loader; // as files may have changed
  take_over(std::move(document), std::move(scene), loader);
  loader_ = std::move(loader);
}

void Session::set(const nlohmann::json &values) {
  SetupDocument document = document_;
  change(document, values);
  take_over(std::move(document), scene_, loader_);
}

void Session::take_over(SetupDocument document, std::shared_ptr<const Scene> scene, SetupLoader &loader) {
  auto setup = std::make_shared<const Setup>(scene ? loader.load(document, scene) : loader.load(document));
  taking_.reset();
  setup_ = std::move(setup);
  document_ = std::move(document);
  scene_ = std::move(scene);
}

TakenFrame Session::take(std::size_t sensor, std::uint32_t number, const RenderRequest &request,
                         const Progress &progress) {
  if (sensor >= setup_->start.sensors.size() || number >= setup_->frames.count)
    throw Error(ExitCode::usage,
                fmt::format("expected a sensor below {} and a frame below {}, found {} and {}",
                            setup_->start.sensors.size(), setup_->frames.count, sensor, number));
  if (request.paths > 0 && !setup_->bounces.any())
    throw Error(ExitCode::usage, "paths: no light bounces in the setup");
  if (request.accuracy.strict && request.accuracy.mode != Mode::exact &&
      exposes_tap_by_tap(*setup_, setup_->start.sensors[sensor]))
    throw Error(ExitCode::accuracy, fmt::format("strict: {}", tap_by_tap_is_exact));
  if (!taking_ || taking_->request != request) {
    taking_.reset(); // its memory first
    auto setup = with_samples(setup_, request.samples);
    const Setup &of = *setup;
    request.channels.require_in(of, request.accuracy);
    taking_.reset(new Taking{std::move(setup), request,
                             Exposures(of, camera_, true, request.accuracy, request.paths, request.channels,
                                       request.output_precision == OutputPrecision::float64)});
  }
  return taking_->exposures.take(sensor, number, Light::beside_lens, progress);
}

} // namespace pmdsim
