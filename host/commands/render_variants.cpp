#include "engine/model/error.h"
#include "host/capture/variant_table.h"
#include "host/commands/commands.h"
#include "host/commands/rendered.h"
#include "host/commands/report_of_run.h"
#include "host/input/file/content_hash.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_directory.h"
#include "host/output/run/run_folder.h"
#include "host/report/report.h"

#include <fmt/format.h>
#include <memory>
#include <set>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

// Writes all frames; their records tell what is in the table of variants.
void render_variant(Capture &capture, const std::string &name) {
  const auto measure = [&](const SensorFrame &at) {
    const auto taken = capture.share(capture.take(at, Light::beside_lens, at.next_s, ", variant " + name));
    MeasuredPart part = rendered_frame(taken, at, capture.formats(), capture.setup().start.scene.objects);
    return MeasuredPart{part.record, [taken, files = std::move(part.files)](FrameRecord &record) {
                          record.told = frame_summary(taken->measurement);
                          return files(record);
                        }};
  };
  capture.write(measure, bytes_of_rendered_frame(capture));
}

ordered_json variant_json(const Variant &variant, const Capture &capture) {
  ordered_json frames = ordered_json::array();
  capture.for_each_sensor_frame(
      [&](const ordered_json &of_sensor) { frames.push_back(frame_told(of_sensor, capture.sequence())); });
  return {{"name", variant.name}, {"changes", variant.changes}, {"frames", frames}};
}

// All variants, those of the shard, and whether several have noise and all of it comes from the same seeds.
struct Study {
  std::vector<Variant> all, own;
  bool has_noise_in_common = false;
};

std::vector<std::uint64_t> noise_seeds(const Setup &setup) {
  std::vector<std::uint64_t> seeds;
  for (const Sensor &sensor : setup.start.sensors)
    if (sensor.electronics)
      seeds.push_back(sensor.electronics->seed);
  return seeds;
}

// What is wrong with any of them is told before the first is measured.
Study checked_study(const Options &options, SetupLoader &loader) {
  std::vector<SetupDocument> documents;
  for (const std::filesystem::path &file : options.setups)
    documents.push_back(requested_document(options.capture, file));
  Study study;
  study.all = variants_of(documents, options.variants);
  std::set<std::vector<std::uint64_t>> seeds;
  for (std::size_t i = 0; i < study.all.size(); ++i) {
    const Variant &variant = study.all[i];
    try {
      CaptureRequest request = options.capture;
      request.shard = {};
      const Setup setup = loader.load(variant.document);
      require_measurable(request, setup);
      seeds.insert(noise_seeds(setup));
    } catch (const Error &error) {
      throw Error(error.code(), fmt::format("{}, in variant {}", error.what(), variant.name), error.where());
    }
    if (i % options.capture.shard.count == options.capture.shard.index)
      study.own.push_back(variant);
  }
  study.has_noise_in_common = study.all.size() > 1 && seeds.size() == 1 && !seeds.begin()->empty();
  return study;
}

// So that processes of another study cannot come between those of this one.
RunIdentity identity_of(const Study &study) {
  std::string texts;
  for (const Variant &variant : study.all)
    texts += content_hash(variant.name + variant.document.json.dump());
  const ordered_json head{{"command", "render"},
                          {"setup", study.all.front().document.json},
                          {"variants", study.all.size()},
                          {"study", content_hash(texts)}};
  return {head, content_hash(head.dump())};
}

// Shards that write to one directory have a table each.
std::string table_name(const Shard &shard) {
  return shard.count == 1 ? "table.csv" : fmt::format("table.{}-of-{}.csv", shard.index, shard.count);
}

constexpr const char *noise_in_common_text =
    "The noise of all variants is the same, as its seed is. For noise of their own, as pairs for training "
    "need,\n"
    "give each variant a \"sensors/0/electronics/seed\", or make frames of one setup with --poses.\n";

class VariantRun {
public:
  explicit VariantRun(const Options &options)
      : options_(options), study_(checked_study(options, loader_)),
        camera_(std::make_shared<Camera>(options.capture.device)),
        folder_(options.capture.output_directory, identity_of(study_), {0, 0, 1},
                options.capture.resume ? RunFolder::Earlier::kept : RunFolder::Earlier::made_again,
                throw_if_interrupted),
        table_(study_.own), json_{{"device", camera_->device()},
                                  {"mode", mode_name(options.capture.accuracy.mode)},
                                  {"variants", ordered_json::array()}} {}

  void run() {
    if (const auto left = folder_.left_warning())
      warn(*left);
    for (std::size_t i = 0; i < study_.own.size(); ++i) {
      try {
        run_variant(i);
      } catch (const Error &error) {
        if (i == 0)
          throw;
        const bool goes_on = error.code() == ExitCode::interrupted;
        throw Error(error.code(), fmt::format("{}; {} of {} variants are whole and stay{}", error.what(), i,
                                              study_.own.size(), goes_on ? ", --resume goes on" : ""));
      }
    }
    tell();
  }

private:
  void run_variant(std::size_t i) {
    const Variant &variant = study_.own[i];
    CaptureRequest request = options_.capture;
    request.shard = {};
    refuse_linked_folders(folder_.path(), variant.name);
    request.output_directory = folder_.path() / variant.name;
    request.part = {i, study_.own.size(), clock_};
    Capture capture(request, requested_setup(request, variant.document, loader_), "render", true,
                    request.channels, camera_);
    render_variant(capture, fmt::format("{} of {}, {}", i + 1, study_.own.size(), variant.name));
    report_of_run(options_, capture);
    capture.for_each_sensor_frame([&](const ordered_json &of_sensor) { table_.add(variant, of_sensor); });
    if (options_.json)
      json_["variants"].push_back(variant_json(variant, capture));
  }

  void tell() {
    const std::string written =
        table_.empty() ? "" : table_.write(folder_.path(), table_name(options_.capture.shard));
    json_["table"] = written;
    if (options_.json)
      return print(json_text(json_));
    print(fmt::format("device    {} ({})\n\n{}{}\nwritten:\n  {}, a folder for each variant beside it\n",
                      camera_->device(), camera_->driver(), table_.text(),
                      study_.has_noise_in_common ? noise_in_common_text : "", written));
  }

  const Options &options_;
  SetupLoader loader_;
  Study study_;
  std::shared_ptr<Camera> camera_;
  RunFolder folder_; // of all variants; each has one of its own in it
  VariantTable table_;
  ordered_json json_;
  std::shared_ptr<ProgressClock> clock_ = std::make_shared<ProgressClock>();
};

} // namespace

void run_variants(const Options &options) { VariantRun(options).run(); }

} // namespace pmdsim
