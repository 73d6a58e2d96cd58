#include "host/bench/real/suite.h"

#include "host/bench/temporary_directory.h"
#include "host/capture/exposure.h"
#include "host/capture/progress.h"

#include <chrono>
#include <fmt/format.h>

namespace pmdsim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int prepared_times = 3;
constexpr int suite_rounds = 7;
constexpr double most_ms_of_rounds = 30e3; // none begins after it
constexpr int peer_frames = 2;             // of a round, the last of which counts

class KindInTurn {
public:
  KindInTurn(const SceneKind &kind, const SuiteScenes &scenes, const BenchRequest &request)
      : setup_(setup_of_kind(kind, scenes.triangles, scenes.columns)), request_(request),
        camera_(request.device), bar_(suite_rounds + 3.0) {
    row_.name = kind.name;
    row_.triangles = setup_.start.scene.triangles.size();
    row_.interactions =
        samples_of_frame(setup_) * static_cast<double>(diode_count(setup_.start.illuminators));
  }

  SuiteRow measure(const std::optional<Peer> &peer) {
    bar_.begin(row_.name + ", checking", 1.0);
    row_.check = check_some_pixels(setup_, request_);
    const auto start = Clock::now();
    prepare();
    camera_.reuse(frame("first frame"));
    row_.first_frame_ms = ms_since(start);
    row_.path = camera_.path();
    time_frames(peer);
    bar_.begin(row_.name + ", preparing", 1.0);
    std::vector<double> prepares_ms;
    for (int i = 0; i < prepared_times; ++i)
      prepares_ms.push_back(prepare());
    row_.prepare_ms = spread_of(prepares_ms).median;
    return std::move(row_);
  }

private:
  // The time that it takes.
  double prepare() {
    const auto start = Clock::now();
    camera_.prepare(setup_, setup_.start.sensors.front(), request_.accuracy);
    return ms_since(start);
  }

  Measurement frame(const std::string &what) {
    bar_.begin(fmt::format("{}, {}", row_.name, what), 1.0);
    return camera_.measure(interruptible_progress(bar_));
  }

  void time_frames(const std::optional<Peer> &peer) {
    const TemporaryDirectory directory;
    std::optional<SceneFiles> files;
    if (peer)
      files = write_scene_files(directory.path(), row_.name, setup_);
    const auto start = Clock::now();
    for (int round = 1; round <= suite_rounds && (round == 1 || ms_since(start) < most_ms_of_rounds);
         ++round) {
      Measurement measured = frame(fmt::format("timing {}/{}", round, suite_rounds));
      add(row_.frames.emplace_back(), measured);
      camera_.reuse(std::move(measured));
      if (peer)
        row_.peer_frames_ms.push_back(
            last_frame_ms(*peer, *files, setup_.start.sensors.front(), peer_frames));
    }
  }

  Setup setup_;
  const BenchRequest &request_;
  Camera camera_;
  ProgressBar bar_;
  SuiteRow row_;
};

} // namespace

std::vector<SuiteRow> run_suite(const SuiteScenes &scenes, const BenchRequest &request,
                                const std::optional<Peer> &peer) {
  std::vector<SuiteRow> rows;
  for (const SceneKind &kind : scenes.kinds)
    rows.push_back(KindInTurn(kind, scenes, request).measure(peer));
  return rows;
}

std::optional<double> speed_over_peer(const SuiteRow &row) {
  if (row.peer_frames_ms.empty())
    return std::nullopt;
  return spread_of(row.peer_frames_ms).median / timing_of(row.frames).frame_ms.median;
}

} // namespace pmdsim
