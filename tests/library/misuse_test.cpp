// The C interface refuses what is wrong by a status and a line, and does not crash.

#include "tests/library/fixture.h"

#include <cmath>
#include <limits>

using namespace pmdsim::test;

namespace {

// A struct as a caller of another version would have it: `beyond` bytes more than ours, all of them `filled`.
struct LargerOptions {
  pmdsim_render_options options{};
  unsigned char beyond[16]{};
};

struct Triangle {
  double positions_m[9]{0, 0, -1, 1, 0, -1, 0, 1, -1};
  std::uint32_t triangles[3]{0, 1, 2};
  double reflectivity = 1.0;
  std::uint32_t object = 0;
  pmdsim_mesh mesh{sizeof(pmdsim_mesh), positions_m, 3, triangles, 1, &reflectivity, &object, 0};

  pmdsim_status load(const Loaded &on) const {
    const std::string text = with(small_setup(), R"("scene": "wall.gltf",)", "");
    return pmdsim_simulator_load_mesh(on.simulator, text.data(), text.size(), nullptr, &mesh);
  }
};

pmdsim_status render(const Loaded &on, const pmdsim_render_options &options) {
  pmdsim_frame *frame = nullptr;
  const pmdsim_status status = pmdsim_render(on.simulator, 0, 0, &options, &frame);
  CHECK((frame != nullptr) == (status == PMDSIM_OK));
  if (frame)
    pmdsim_frame_destroy(frame);
  return status;
}

pmdsim_render_options options() {
  pmdsim_render_options all{};
  all.struct_size = sizeof(all);
  return all;
}

bool tells(const std::string &part) {
  INFO(told());
  return told().find(part) != std::string::npos && told().find('\n') == std::string::npos;
}

} // namespace

TEST_CASE("Files outside of the scene's folder are allowed or not") {
  const Loaded loaded;
  CHECK(pmdsim_simulator_allow_outside(loaded.simulator, 1) == PMDSIM_OK);
  CHECK(pmdsim_simulator_allow_outside(loaded.simulator, 0) == PMDSIM_OK);
  CHECK(pmdsim_simulator_allow_outside(loaded.simulator, 2) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("allowed: expected 0 or 1, found 2"));
  CHECK(pmdsim_simulator_allow_outside(nullptr, 1) == PMDSIM_BAD_HANDLE);
}

TEST_CASE("Handles that are none, or no more") {
  const Loaded loaded;
  pmdsim_frame *frame = loaded.render();
  int none = 0;
  auto *const never_one = reinterpret_cast<pmdsim_simulator *>(&none);
  const char *text = nullptr;
  std::size_t count = 7;
  pmdsim_channel channel{};
  channel.struct_size = sizeof(channel);
  CHECK(pmdsim_simulator_describe(never_one, &text) == PMDSIM_BAD_HANDLE);
  CHECK(tells("expected a simulator"));
  CHECK(pmdsim_simulator_load(nullptr, "x.json") == PMDSIM_BAD_HANDLE);
  CHECK(pmdsim_simulator_cancel(reinterpret_cast<pmdsim_simulator *>(frame)) == PMDSIM_BAD_HANDLE);
  CHECK(pmdsim_frame_destroy(frame) == PMDSIM_OK);
  CHECK(pmdsim_frame_destroy(frame) == PMDSIM_BAD_HANDLE);
  CHECK(pmdsim_frame_channel_count(frame, &count) == PMDSIM_BAD_HANDLE);
  CHECK(count == 7);
  CHECK(pmdsim_frame_find(frame, "amplitude", &channel) == PMDSIM_BAD_HANDLE);
  CHECK(channel.values == nullptr);
  CHECK(pmdsim_frame_report(frame, &text) == PMDSIM_BAD_HANDLE);
  CHECK(pmdsim_frame_destroy(nullptr) == PMDSIM_OK);
  pmdsim_simulator *second = nullptr;
  REQUIRE(pmdsim_simulator_create("", &second) == PMDSIM_OK);
  CHECK(pmdsim_simulator_destroy(second) == PMDSIM_OK);
  CHECK(pmdsim_simulator_destroy(second) == PMDSIM_BAD_HANDLE);
  CHECK(pmdsim_render(second, 0, 0, nullptr, &frame) == PMDSIM_BAD_HANDLE);
}

TEST_CASE("Arguments that are NULL") {
  const Loaded loaded;
  pmdsim_frame *frame = loaded.render();
  CHECK(pmdsim_simulator_create(nullptr, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_load(loaded.simulator, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_load_text(loaded.simulator, nullptr, 5, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_set(loaded.simulator, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_describe(loaded.simulator, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_render(loaded.simulator, 0, 0, nullptr, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_frame_channel_count(frame, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_frame_find(frame, nullptr, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_frame_find(frame, "amplitude", nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_frame_directions(frame, nullptr, 1000) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_devices(nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_schema(nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_channels(nullptr) == PMDSIM_BAD_ARGUMENT);
  const char *told = nullptr;
  CHECK(pmdsim_report(nullptr, nullptr, 0.0, &told) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_report("nowhere", nullptr, 0.0, nullptr) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_report("nowhere", nullptr, 0.5, &told) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_report("nowhere", nullptr, 0.0, &told) == PMDSIM_BAD_INPUT);
  pmdsim_frame_destroy(frame);
}

TEST_CASE("Structs of other versions") {
  const Loaded loaded;
  pmdsim_render_options none{};
  CHECK(render(loaded, none) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("struct_size"));
  LargerOptions larger;
  larger.options.struct_size = sizeof(larger);
  CHECK(render(loaded, larger.options) == PMDSIM_OK);
  larger.beyond[15] = 1;
  CHECK(render(loaded, larger.options) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("expected 0 beyond"));
  pmdsim_frame *frame = loaded.render();
  pmdsim_channel channel{};
  channel.struct_size = 8;
  CHECK(pmdsim_frame_channel(frame, 0, &channel) == PMDSIM_BAD_ARGUMENT);
  CHECK(channel.values == nullptr);
  pmdsim_frame_destroy(frame);
}

TEST_CASE("Options that are wrong") {
  const Loaded loaded;
  const auto status_with = [&](auto member, auto value) {
    pmdsim_render_options wrong = options();
    wrong.*member = value;
    return render(loaded, wrong);
  };
  using Options = pmdsim_render_options;
  CHECK(status_with(&Options::mode, "quick") == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("expected auto or exact or reduced, found \"quick\""));
  CHECK(status_with(&Options::max_error_m, -1.0) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::max_error_m, std::nan("")) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::max_amplitude_error, 2.0) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::precision, "fp16") == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::samples, "0") == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::samples, "2x2") == PMDSIM_BAD_ARGUMENT);
  CHECK(status_with(&Options::paths, 100u) == PMDSIM_BAD_ARGUMENT); // only the reference follows paths
  CHECK(status_with(&Options::strict, 1) == PMDSIM_OK);             // nothing is to warn of
  CHECK(status_with(&Options::channels, "distance") == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("unknown channel \"distance\""));
  CHECK(told().starts_with("channels: "));
  CHECK(status_with(&Options::max_error_m, 1e-5) == PMDSIM_OK);
}

TEST_CASE("Frames, channels and setups that are not there") {
  const Loaded loaded;
  pmdsim_frame *frame = nullptr;
  CHECK(pmdsim_render(loaded.simulator, 1, 0, nullptr, &frame) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_render(loaded.simulator, 0, 1, nullptr, &frame) == PMDSIM_BAD_ARGUMENT);
  CHECK(frame == nullptr);
  frame = loaded.render();
  pmdsim_channel channel{};
  channel.struct_size = sizeof(channel);
  CHECK(pmdsim_frame_channel(frame, 1000, &channel) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_frame_find(frame, "distance", &channel) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("expected one of amplitude, "));
  double room = 0.0;
  CHECK(pmdsim_frame_directions(frame, &room, 1) == PMDSIM_BAD_ARGUMENT);
  pmdsim_frame_destroy(frame);
  pmdsim_simulator *empty = nullptr;
  REQUIRE(pmdsim_simulator_create(nullptr, &empty) == PMDSIM_OK);
  CHECK(pmdsim_render(empty, 0, 0, nullptr, &frame) == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_set(empty, "{}") == PMDSIM_BAD_ARGUMENT);
  CHECK(pmdsim_simulator_destroy(empty) == PMDSIM_OK);
  CHECK(pmdsim_simulator_create("no such device", &empty) == PMDSIM_NO_DEVICE);
}

TEST_CASE("Setups and changes that are wrong") {
  const Loaded loaded;
  const auto status_of = [&](const char *changes) { return pmdsim_simulator_set(loaded.simulator, changes); };
  CHECK(status_of("{") == PMDSIM_BAD_INPUT);
  CHECK(status_of("[1]") == PMDSIM_BAD_INPUT);
  CHECK(status_of(R"({"": 1})") == PMDSIM_BAD_INPUT);
  CHECK(status_of(R"({"sensors/5/taps": 4})") == PMDSIM_BAD_INPUT);
  CHECK(status_of(R"({"sensors/nobody/taps": 4})") == PMDSIM_BAD_INPUT);
  CHECK(tells("/sensors: cannot set"));
  CHECK(status_of(R"({"sensors/0/taps/x": 4})") == PMDSIM_BAD_INPUT);
  CHECK(status_of(R"({"sensors/0/tapz": 4})") == PMDSIM_BAD_INPUT);
  CHECK(tells("unknown key \"tapz\""));
  CHECK(status_of(R"({"sensors/0/resolution": [-8, 8]})") == PMDSIM_BAD_INPUT);
  CHECK(status_of(R"({"~2": 1})") == PMDSIM_BAD_INPUT);
  CHECK(pmdsim_simulator_load(loaded.simulator, "/no/such.json") == PMDSIM_BAD_INPUT);
  CHECK(std::string(pmdsim_error_file()) == "/no/such.json");
  CHECK(pmdsim_simulator_load_text(loaded.simulator, "\"text\"", 6, nullptr) == PMDSIM_BAD_INPUT);
  CHECK(tells("the setup: "));
  CHECK(std::string(pmdsim_error_file()).empty());
  CHECK(status_of("[") == PMDSIM_BAD_INPUT);
  CHECK(tells("the changes:1:"));
  CHECK(std::string(pmdsim_error_file()).empty());
  pmdsim_frame *frame = loaded.render(); // the setup is what it was
  pmdsim_frame_destroy(frame);
}

TEST_CASE("Meshes that are wrong") {
  const Loaded loaded;
  const auto status_of = [&](const auto &spoil) {
    Triangle triangle;
    spoil(triangle);
    return triangle.load(loaded);
  };
  CHECK(status_of([](Triangle &) {}) == PMDSIM_OK);
  CHECK(status_of([](Triangle &of) { of.positions_m[4] = std::nan(""); }) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("positions_m: vertex 1"));
  CHECK(status_of([](Triangle &of) { of.positions_m[0] = std::numeric_limits<double>::infinity(); }) ==
        PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.triangles[2] = 3; }) == PMDSIM_BAD_ARGUMENT);
  CHECK(tells("triangle 0: expected vertices below 3, found 3"));
  CHECK(status_of([](Triangle &of) { of.reflectivity = 1.5; }) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.object = 9; }) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.mesh.positions_m = nullptr; }) == PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.mesh.vertex_count = std::numeric_limits<std::size_t>::max(); }) ==
        PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.mesh.triangle_count = std::size_t{1} << 40; }) ==
        PMDSIM_BAD_ARGUMENT);
  CHECK(status_of([](Triangle &of) { of.mesh.struct_size = 3; }) == PMDSIM_BAD_ARGUMENT);
  const std::string with_scene = small_setup();
  const Triangle good;
  CHECK(pmdsim_simulator_load_mesh(loaded.simulator, with_scene.data(), with_scene.size(), nullptr,
                                   &good.mesh) == PMDSIM_BAD_INPUT);
  CHECK(std::string(pmdsim_error_place()) == "/scene");
  CHECK(pmdsim_simulator_load_mesh(loaded.simulator, with_scene.data(), with_scene.size(), nullptr,
                                   nullptr) == PMDSIM_BAD_ARGUMENT);
}

TEST_CASE("What failed is told to its thread until its next call") {
  const Loaded loaded;
  CHECK(pmdsim_simulator_load(loaded.simulator, "/no/such.json") == PMDSIM_BAD_INPUT);
  CHECK(tells("/no/such.json"));
  CHECK(pmdsim_simulator_set(loaded.simulator, "{}") == PMDSIM_OK);
  CHECK(told().empty());
}
