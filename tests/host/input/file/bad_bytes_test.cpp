// Good files with some of their bytes lost or changed either load or are refused in one line; nothing else
// happens.

#include "host/input/gltf/loader.h"
#include "tests/host/input/gltf/meshopt_builder.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <fstream>
#include <iterator>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

constexpr int trials = 600; // for each kind of file and of damage

std::string truncated(const std::string &bytes, std::mt19937 &random) {
  return bytes.substr(0, random() % bytes.size());
}

std::string flipped(std::string bytes, std::mt19937 &random) {
  const unsigned flips = 1 + random() % 4;
  for (unsigned i = 0; i < flips; ++i)
    bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
  return bytes;
}

// `load` gets the damaged bytes; what it throws has to be an Error in one line. Returns how many were
// refused.
template <class Load>
int refused_of(const std::string &bytes, Load load) {
  std::mt19937 random(20070605);
  int refused = 0;
  for (int i = 0; i < 2 * trials; ++i) {
    const std::string damaged = i % 2 == 0 ? truncated(bytes, random) : flipped(bytes, random);
    try {
      load(damaged);
    } catch (const Error &error) {
      ++refused;
      REQUIRE(error.code() == ExitCode::input);
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  return refused;
}

json furnished_scene() {
  json gltf = document(triangle_positions(), {0, 1, 2}, 4);
  gltf["materials"] = {{{"doubleSided", true}, {"extras", {{"pmdsim_reflectivity", 0.5}}}}};
  gltf["meshes"][0]["primitives"][0]["material"] = 0;
  gltf["nodes"].push_back({{"children", {0}}, {"rotation", {0, 0, 0, 1}}, {"scale", {1, 2, 3}}});
  gltf["scenes"][0]["nodes"] = {1};
  return gltf;
}

} // namespace

TEST_CASE("Damaged .gltf files") {
  const TemporaryFolder folder;
  const int refused = refused_of(furnished_scene().dump(), [&](const std::string &bytes) {
    const auto file = folder.write("scene.gltf", bytes);
    load_gltf(file, Place{file}).at(0);
  });
  CHECK(refused > trials);
}

TEST_CASE("Damaged .glb files") {
  const TemporaryFolder folder;
  const std::string chunk = bytes_of(triangle_positions()) + bytes_of<std::uint16_t>({0, 1, 2});
  const int refused = refused_of(glb(furnished_scene(), chunk), [&](const std::string &bytes) {
    const auto file = folder.write("scene.glb", bytes);
    load_gltf(file, Place{file}).at(0);
  });
  CHECK(refused > trials);
}

TEST_CASE("Damaged .gltf files with sparse and compressed parts") {
  json gltf = compressed_square();
  const std::size_t indices = add_view(gltf, bytes_of<std::uint8_t>({1, 3}));
  const std::size_t values = add_view(gltf, bytes_of<float>({2, 0, -1, 0, 2, -1}));
  gltf["accessors"][0]["sparse"] = {{"count", 2},
                                    {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                    {"values", {{"bufferView", values}}}};
  const TemporaryFolder folder;
  const int refused = refused_of(gltf.dump(), [&](const std::string &bytes) {
    const auto file = folder.write("scene.gltf", bytes);
    load_gltf(file, Place{file}).at(0);
  });
  CHECK(refused > trials);
}

TEST_CASE("Damaged .glb files as gltfpack writes them") {
  const TemporaryFolder folder;
  for (const std::string name : {"compressed_more.glb", "floats.glb"}) {
    std::ifstream stream(std::string(PMDSIM_TEST_FILES "/packed/") + name, std::ios::binary);
    const std::string packed(std::istreambuf_iterator<char>(stream), {});
    const int refused = refused_of(packed, [&](const std::string &bytes) {
      const auto file = folder.write("scene.glb", bytes);
      load_gltf(file, Place{file}).at(0);
    });
    CHECK(refused > trials);
  }
}

TEST_CASE("Damaged setups") {
  SetupFixture fixture;
  fixture.load();
  fixture.sensor()["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", {0, 0, -1}}};
  const int refused =
      refused_of(fixture.setup.dump(), [&](const std::string &bytes) { fixture.load_text(bytes); });
  CHECK(refused > trials);
}

TEST_CASE("Damaged diode files") {
  SetupFixture fixture;
  fixture.load();
  fixture.illuminator()["diodes"] = {{"file", "diodes.csv"}};
  const std::string good = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n"
                           "0,0.05,0,0,0,1,1,isotropic\n0.1,-2e-2,0.25,0,0.6,0.8,0.5,3.5\n";
  const int refused = refused_of(good, [&](const std::string &bytes) {
    fixture.folder.write("diodes.csv", bytes);
    fixture.load_text(fixture.setup.dump());
  });
  CHECK(refused > trials / 2);
}

TEST_CASE("Damaged radiation diagrams") {
  SetupFixture fixture;
  fixture.load();
  const auto refused_with = [&](const std::string &name, const std::string &good) {
    fixture.illuminator()["pattern"] = {{"file", name}};
    return refused_of(good, [&](const std::string &bytes) {
      fixture.folder.write(name, bytes);
      fixture.load_text(fixture.setup.dump());
    });
  };
  CHECK(refused_with("led.csv", "theta_deg,phi_deg,relative\n0,0,1\n0,120,1\n45,0,0.5\n45,120,0.25\n") >
        trials / 2);
  CHECK(refused_with("led.ies",
                     "IESNA91\nTILT=INCLUDE\n1 2 0 90 1 1\n1 -1 1 3 2 1 2 0 0 0 1 1 1\n0 45 90\n0 90\n"
                     "4 2 1\n4 1 0\n") > trials / 2);
}
