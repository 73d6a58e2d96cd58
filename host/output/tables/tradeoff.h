#pragma once
// Speed against accuracy, as tables.

#include "engine/model/accuracy.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// Errors of distances, wrapped, against the reference.
struct DistanceErrors {
  std::size_t pixels = 0;
  std::optional<double> max_m, rms_m; // nothing where there are no pixels
};

// The quantity that varies from point to point: modes and precisions at the setup's samples, or the samples
// in mode exact. Each sweep has a truth, and so a Pareto front, of its own.
enum class Sweep { modes, samples };

struct FrameTime {
  double median_ms = 0.0, min_ms = 0.0, max_ms = 0.0; // of warm frames
};

struct TradeoffPoint {
  Sweep sweep = Sweep::modes;
  Accuracy accuracy{}; // asked for
  std::uint32_t samples = 1;
  bool adaptive_samples = false;
  std::uint32_t reference_samples = 1; // S of the reference that it is compared with
  std::string refusal = {}; // why it has no frames, in one line; empty where it has, and what follows
  FrameTime time{};
  AccuracyReport report{};
  DistanceErrors smooth{}, edges{}; // of pixels beside edges and on them
  bool pareto = false;              // no point of the sweep is both as fast and as accurate
};

struct Tradeoff {
  std::string setup, sensor, device, driver; // the setup's file
  std::vector<TradeoffPoint> points;
};

// By median time and largest error beside edges; points without either are never on a front.
void mark_pareto(std::vector<TradeoffPoint> &points);

nlohmann::ordered_json tradeoff_json(const Tradeoff &tradeoff);
// A line a point after a header line, the keys of tradeoff_json()'s points; empty where there is nothing.
std::string tradeoff_csv(const Tradeoff &tradeoff);
// For people, and for BENCHMARKS.md.
std::string tradeoff_text(const Tradeoff &tradeoff);
std::string tradeoff_markdown(const Tradeoff &tradeoff);
// "exact", "reduced", "auto" or "samples", by colour in the picture.
std::string series_name(const TradeoffPoint &point);
// The label that tells the point from others of its series: "fp32", "0.1 µm", "S = 4".
std::string point_label(const TradeoffPoint &point);

} // namespace pmdsim
