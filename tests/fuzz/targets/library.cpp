// The C interface: calls one after the other on a few handles, decoded from bytes, of the device "reference".
// Arguments keep the promises of host/library/pmdsim.h (arrays are as long as they are said to be, text ends
// with NUL); all else may be wrong.

#include "tests/fuzz/target.h"

#include "host/library/pmdsim.h"
#include "tests/fuzz/decoder.h"
#include "tests/fuzz/small_files.h"

#include <bit>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

using namespace pmdsim;

namespace {

constexpr std::size_t handles = 3;

// Frames that take longer than a fuzzer has are not measured.
bool is_cheap(pmdsim_simulator *simulator) {
  const char *text = nullptr;
  if (pmdsim_simulator_describe(simulator, &text) != PMDSIM_OK)
    return true; // no setup, which the call has to find itself
  const auto setup = nlohmann::json::parse(text).at("setup");
  if (setup.is_null())
    return true;
  if (setup.dump().size() > 4000 || setup.value("bounces", 0) != 0)
    return false;
  double work = 0.0;
  for (const auto &sensor : setup.at("sensors")) {
    const double samples = sensor.at("samples").is_number() ? sensor.at("samples").get<double>() : 4.0;
    work += sensor.at("resolution")[0].get<double>() * sensor.at("resolution")[1].get<double>() * samples *
            samples * static_cast<double>(sensor.at("modulation_hz").size());
    if (sensor.contains("electronics"))
      work *= sensor.at("electronics").at("frames_averaged").get<double>();
  }
  double diodes = 0.0;
  for (const auto &illuminator : setup.at("illuminators"))
    for (const auto &ring : illuminator.at("diodes").value("rings", nlohmann::json::array()))
      diodes += ring.value("count", 1.0);
  return work * (1.0 + diodes) < 1e4;
}

double any_double(fuzz::Decoder &bytes) {
  constexpr std::array values{0.0, 1.0, -1.0, 0.5, 1e9, -1e9, 1e10, 1e-300, 1e308, -0.0};
  return bytes.flag() ? bytes.one_of(values) : std::bit_cast<double>(bytes.bits(8));
}

// Longer than it says, so that a struct_size beyond its own names bytes that are there.
template <class Struct>
struct Room {
  Struct content{};
  std::array<unsigned char, 8192> beyond{};

  explicit Room(fuzz::Decoder &bytes) {
    constexpr std::array<std::size_t, 6> sizes{sizeof(Struct), sizeof(Struct) + 8, 0, 8, 4097, SIZE_MAX};
    content.struct_size = bytes.below(4) == 3 ? bytes.one_of(sizes) : sizeof(Struct);
    if (bytes.below(8) == 7)
      beyond[bytes.below(16)] = 1;
  }
};

class Calls {
public:
  explicit Calls(fuzz::Decoder bytes) : bytes_(bytes) {}
  Calls(const Calls &) = delete;
  Calls &operator=(const Calls &) = delete;
  ~Calls() {
    for (pmdsim_simulator *simulator : simulators_)
      pmdsim_simulator_destroy(simulator);
    for (pmdsim_frame *frame : frames_)
      pmdsim_frame_destroy(frame);
  }

  void all() {
    create(0);
    check(pmdsim_simulator_load_text(simulators_[0], fuzz::small_setup, std::strlen(fuzz::small_setup),
                                     folder_.c_str()));
    for (std::size_t calls = 0; calls < 24 && !bytes_.is_at_end(); ++calls)
      one();
  }

private:
  void check(pmdsim_status status) {
    const std::string_view message = pmdsim_error_message();
    fuzz::check_line(message);
    fuzz::check_line(pmdsim_error_file());
    fuzz::check_line(pmdsim_error_place());
    if (status == PMDSIM_INTERNAL || (status == PMDSIM_OK) != message.empty())
      throw std::logic_error("status " + std::to_string(status) + ": " + std::string(message));
  }

  void create(std::size_t index) {
    if (simulators_[index])
      check(pmdsim_simulator_destroy(simulators_[index]));
    check(pmdsim_simulator_create("reference", &simulators_[index]));
  }

  void load_mesh(pmdsim_simulator *simulator) {
    std::vector<double> positions_m(3 * bytes_.below(8)), reflectivity(8);
    std::vector<std::uint32_t> triangles(3 * bytes_.below(8)), object_ids(8);
    for (double &coordinate_m : positions_m)
      coordinate_m = any_double(bytes_);
    for (std::uint32_t &vertex : triangles)
      vertex = static_cast<std::uint32_t>(bytes_.below(9));
    for (double &share : reflectivity)
      share = bytes_.flag() ? 0.5 : any_double(bytes_);
    for (std::uint32_t &id : object_ids)
      id = static_cast<std::uint32_t>(bytes_.below(9));
    Room<pmdsim_mesh> mesh(bytes_);
    mesh.content.vertex_count = positions_m.size() / 3;
    mesh.content.triangle_count = triangles.size() / 3;
    mesh.content.positions_m = bytes_.below(8) == 7 ? nullptr : positions_m.data();
    mesh.content.triangles = bytes_.below(8) == 7 ? nullptr : triangles.data();
    if (bytes_.below(8) == 7)
      mesh.content.vertex_count = mesh.content.positions_m ? mesh.content.vertex_count : bytes_.bits(8);
    mesh.content.reflectivity = bytes_.flag() ? reflectivity.data() : nullptr;
    mesh.content.object_ids = bytes_.flag() ? object_ids.data() : nullptr;
    mesh.content.double_sided = static_cast<int>(bytes_.below(3));
    const char *text = bytes_.below(4) == 3 ? fuzz::small_setup : fuzz::small_setup_without_scene;
    check(pmdsim_simulator_load_mesh(simulator, text, std::strlen(text), folder_.c_str(),
                                     bytes_.below(8) == 7 ? nullptr : &mesh.content));
  }

  void render(pmdsim_simulator *simulator) {
    constexpr std::array<const char *, 6> modes{nullptr, "exact", "auto", "reduced", "", "fast"};
    constexpr std::array<const char *, 6> samples{nullptr, "1", "2", "auto", "17", "-1"};
    constexpr std::array<const char *, 8> channels{
        nullptr, "all", "distance_m,amplitude", "normals,rays", "all,,x", "\xff\n,lit", "f0.distance_m", ""};
    Room<pmdsim_render_options> options(bytes_);
    options.content.mode = bytes_.one_of(modes);
    options.content.max_error_m = bytes_.flag() ? any_double(bytes_) : 0.0;
    options.content.max_amplitude_error = bytes_.flag() ? any_double(bytes_) : 0.0;
    options.content.precision = bytes_.one_of(std::array<const char *, 4>{nullptr, "fp64", "fp32", "\x80"});
    options.content.samples = bytes_.one_of(samples);
    options.content.channels = bytes_.one_of(channels);
    options.content.paths = bytes_.below(8) == 7 ? static_cast<std::uint32_t>(bytes_.bits(4)) : 0;
    options.content.strict = static_cast<int>(bytes_.below(2));
    options.content.output_precision =
        bytes_.one_of(std::array<const char *, 4>{nullptr, "float64", "float32", "x"});
    pmdsim_frame *&frame = frames_[bytes_.below(handles)];
    const auto sensor = static_cast<std::uint32_t>(bytes_.below(3));
    const auto number = static_cast<std::uint32_t>(bytes_.below(3));
    if (!is_cheap(simulator))
      return;
    if (frame)
      check(pmdsim_frame_destroy(frame));
    frame = nullptr;
    check(pmdsim_render(simulator, sensor, number, bytes_.flag() ? &options.content : nullptr, &frame));
  }

  void look_at(pmdsim_frame *frame) {
    std::size_t count = 0;
    const char *text = nullptr;
    check(pmdsim_frame_channel_count(frame, &count));
    Room<pmdsim_channel> channel(bytes_);
    check(pmdsim_frame_channel(frame, bytes_.below(40), &channel.content));
    check(pmdsim_frame_find(frame, bytes_.flag() ? "distance_m" : bytes_.text().c_str(), &channel.content));
    check(pmdsim_frame_report(frame, &text));
    std::vector<double> directions(bytes_.below(64));
    check(pmdsim_frame_directions(frame, directions.data(), directions.size()));
  }

  void one() {
    const std::size_t index = bytes_.below(handles);
    pmdsim_simulator *simulator = simulators_[index];
    pmdsim_frame *&frame = frames_[index];
    const char *text = nullptr;
    switch (bytes_.below(14)) {
    case 0:
      return create(index);
    case 1: // the handle stays, to be used again
      return check(pmdsim_simulator_destroy(simulator));
    case 2: {
      const std::string setup = bytes_.text();
      return check(pmdsim_simulator_load_text(simulator, setup.data(), setup.size(), folder_.c_str()));
    }
    case 3:
      return check(pmdsim_simulator_load_text(simulator, fuzz::small_setup, std::strlen(fuzz::small_setup),
                                              folder_.c_str()));
    case 4:
      return load_mesh(simulator);
    case 5:
    case 6:
      return check(pmdsim_simulator_set(simulator, bytes_.text().c_str()));
    case 7:
      return check(pmdsim_simulator_describe(simulator, &text));
    case 8:
    case 9:
      return render(simulator);
    case 10:
      return look_at(frame);
    case 11:
      return check(pmdsim_frame_destroy(frame));
    case 12:
      return check(
          pmdsim_simulator_cancel(bytes_.flag() ? simulator : reinterpret_cast<pmdsim_simulator *>(frame)));
    default: {
      const std::string content = bytes_.text();
      if (frame)
        check(pmdsim_frame_destroy(frame));
      frame = nullptr;
      check(pmdsim_frame_read(fuzz::write_file("frame.exr", content).c_str(), &frame));
      check(pmdsim_simulator_allow_outside(simulator, static_cast<int>(content.size() % 3)));
      check(pmdsim_simulator_load(simulator, fuzz::write_file("setup.json", content).c_str()));
      fuzz::write_file("manifest.json", content);
      check(pmdsim_report(folder_.c_str(), nullptr, 1.0, &text));
    }
    }
  }

  const std::string folder_ = fuzz::folder().string();
  fuzz::Decoder bytes_;
  std::array<pmdsim_simulator *, handles> simulators_{};
  std::array<pmdsim_frame *, handles> frames_{};
};

} // namespace

FUZZ_TARGET(library) {
  static const std::filesystem::path folder = fuzz::write_small_files();
  static_cast<void>(folder);
  Calls(fuzz::Decoder(data, size)).all();
  return 0;
}
