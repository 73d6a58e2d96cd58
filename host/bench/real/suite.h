#pragma once
// Procedural scenes, checked against the reference and then timed, in turn with another program's frames.

#include "host/bench/real/peer.h"
#include "host/bench/real/pixel_check.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

struct SuiteRow {
  std::string name; // the kind's
  std::size_t triangles = 0;
  double interactions = 0.0; // samples x diodes
  PixelCheck check{};
  double first_frame_ms = 0.0; // from preparing to the result, with all compiling that the check has left
  double prepare_ms = 0.0;     // again, warm; median
  std::vector<TimedFrame> frames{};
  std::vector<double> peer_frames_ms{};                    // beside them; empty without a peer
  std::vector<std::pair<std::string, std::string>> path{}; // Simulator::path()
};

struct SuiteScenes {
  std::vector<SceneKind> kinds;
  std::uint32_t triangles; // of each, about
  std::uint32_t columns;   // and rows
};

// A row each kind, in one mode, exact unless another one is asked for. Throws Error.
std::vector<SuiteRow> run_suite(const SuiteScenes &scenes, const BenchRequest &request,
                                const std::optional<Peer> &peer);

// The peer's median time over the device's; nothing without a peer.
std::optional<double> speed_over_peer(const SuiteRow &row);

} // namespace pmdsim
