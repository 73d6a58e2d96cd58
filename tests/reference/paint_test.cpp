// Surfaces whose reflectivity varies, and the holes that masks cut into them.

#include "engine/reference/reference.h"
#include "tests/reference/monostatic_frame.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <numeric>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Its pixels' rays cross z = 1 at a grid of `pixels` x `pixels` over -1/2 to 1/2, each at the middle of its
// cell.
Sensor square_view(std::uint32_t pixels) {
  Sensor sensor;
  sensor.resolution = glm::uvec2(pixels);
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(sensor.focal_length_m / pixels);
  return sensor;
}

// Fills square_view() at z = 1; texture coordinates and colours beside its corners: top left, bottom left,
// bottom right, top right. u and v are 0 to 1 from the top left.
Scene painted_wall(const Paint &paint, double reflectivity = 0.0) {
  SceneBuilder builder;
  builder.add_wall({1, {reflectivity, false, paint}, {-0.5, -0.5}, {0.5, 0.5}});
  Scene scene = builder.scene();
  scene.texture_coordinates = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  return scene;
}

Paint paint_with(const glm::uvec2 &size, const std::vector<glm::vec4> &texels, TextureFilter filter) {
  Paint paint;
  paint.reflectivity_rgb = {0.2, 0.5, 0.3};
  paint.texture = std::make_shared<const Texture>(Texture{size, texels});
  paint.filter = filter;
  paint.wrap_u = paint.wrap_v = Wrap::clamp;
  return paint;
}

glm::vec4 grey(float value, float alpha = 1.0f) { return {value, value, value, alpha}; }

// The pixels' reflectivities, found from the constant backscatter of the monostatic unit light.
std::vector<double> reflectivities(const reference::Frame &frame) {
  std::vector<double> result = frame.returns[0].amplitude;
  for (std::size_t pixel = 0; pixel < result.size(); ++pixel)
    if (frame.coverage[pixel] > 0)
      result[pixel] *= frame.range_m[pixel] * frame.range_m[pixel];
  return result;
}

void check_close(const std::vector<double> &found, const std::vector<double> &expected) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i);
    CHECK(found[i] == Approx(expected[i]).epsilon(1e-12));
  }
}

} // namespace

TEST_CASE("a checker's texels are the pixels that they fill") {
  std::vector<glm::vec4> texels;
  std::vector<double> expected;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const bool white = (row + column) % 2 == 0;
      texels.push_back(grey(white ? 1.0f : 0.25f));
      expected.push_back(white ? 1.0 : 0.25);
    }
  const auto filter = GENERATE(TextureFilter::nearest, TextureFilter::linear);
  // At the texels' centres; the weights 0.2, 0.5 and 0.3 of a grey add up to 1.
  check_close(
      reflectivities(monostatic_frame(painted_wall(paint_with({4, 4}, texels, filter)), square_view(4))),
      expected);
}

TEST_CASE("row 0 of a texture is at the top, its columns run to the right") {
  const auto paint =
      paint_with({2, 2}, {grey(0.1f), grey(0.2f), grey(0.3f), grey(0.4f)}, TextureFilter::nearest);
  check_close(reflectivities(monostatic_frame(painted_wall(paint), square_view(2))),
              {0.1f, 0.2f, 0.3f, 0.4f});
}

TEST_CASE("a wall whose coordinates run beyond the texture wraps it") {
  auto paint = paint_with({2, 1}, {grey(0.25f), grey(0.75f)}, TextureFilter::nearest);
  const auto [wrap, expected] = GENERATE(table<Wrap, std::vector<double>>({
      {Wrap::repeat, {0.25, 0.75, 0.25, 0.75, 0.25, 0.75}},
      {Wrap::mirrored_repeat, {0.75, 0.25, 0.25, 0.75, 0.75, 0.25}},
      {Wrap::clamp, {0.25, 0.25, 0.25, 0.75, 0.75, 0.75}},
  }));
  paint.wrap_u = wrap;
  Scene scene = painted_wall(paint);
  scene.texture_coordinates = {{-1, 0}, {-1, 1}, {2, 1}, {2, 0}};
  Sensor sensor = square_view(6);
  sensor.resolution = {6, 1};
  check_close(reflectivities(monostatic_frame(scene, sensor)), expected);
}

TEST_CASE("a colour's red, green and blue count by the paint's weights, beside what the surface has") {
  Paint paint;
  paint.reflectivity_rgb = {0.25, 0.5, 0.125};
  Scene scene = painted_wall(paint, 0.0625);
  scene.colours.assign(4, {1.0f, 0.5f, 0.25f, 0.0f});
  check_close(reflectivities(monostatic_frame(scene, square_view(1))), {0.0625 + 0.25 + 0.25 + 0.03125});
  scene.colours.clear(); // white
  check_close(reflectivities(monostatic_frame(scene, square_view(1))), {0.0625 + 0.25 + 0.5 + 0.125});
}

TEST_CASE("a paint that takes more than the surface has leaves black, not less") {
  Paint paint;
  paint.reflectivity_rgb = {-1, 0, 0};
  const auto frame = monostatic_frame(painted_wall(paint, 0.5), square_view(1));
  CHECK(frame.returns[0].amplitude[0] == 0);
  CHECK(std::isnan(frame.returns[0].distance_m[0]));
  CHECK(frame.coverage[0] == 1);
}

TEST_CASE("vertex colours are linear on the triangle") {
  Paint paint;
  paint.reflectivity_rgb = {1, 0, 0};
  SceneBuilder builder;
  // Tilted, so that perspective counts.
  const glm::dvec3 a(-0.5, -0.5, 1), b(-1.0, 1.0, 2), c(1.5, 1.5, 3);
  builder.add_triangle(a, b, c, {0, false, paint});
  Scene scene = builder.scene();
  scene.colours = {{0.2f, 0, 0, 1}, {0.6f, 0, 0, 1}, {0.8f, 0, 0, 1}};

  const auto seen_towards = [&](const glm::dvec3 &point_m) {
    Sensor sensor = axial_sensor();
    const glm::dvec3 forward = glm::normalize(point_m),
                     right = glm::normalize(glm::cross({0, 1, 0}, forward));
    sensor.world_from_camera = compose(
        sensor.world_from_camera, {glm::dmat3(right, glm::cross(forward, right), forward), glm::dvec3(0)});
    const double range_m = glm::length(point_m);
    const auto frame = monostatic_frame(scene, sensor);
    CHECK(frame.range_m[0] == Approx(range_m).epsilon(1e-9));
    return frame.returns[0].amplitude[0] * range_m * range_m;
  };
  const auto inwards = [&](const glm::dvec3 &point_m) { return glm::mix(point_m, (a + b + c) / 3.0, 1e-9); };
  CHECK(seen_towards(inwards((a + b) / 2.0)) == Approx(0.4).epsilon(1e-6));
  CHECK(seen_towards(inwards((b + c) / 2.0)) == Approx(0.7).epsilon(1e-6));
  CHECK(seen_towards(inwards((c + a) / 2.0)) == Approx(0.5).epsilon(1e-6));
  CHECK(seen_towards(inwards(a)) == Approx(0.2).epsilon(1e-6));
  CHECK(seen_towards(0.5 * a + 0.125 * b + 0.375 * c) == Approx(0.1 + 0.075 + 0.3).epsilon(1e-6));
}

TEST_CASE("a vertex colour multiplies the texel") {
  const auto paint = paint_with({2, 1}, {{0.5f, 0.25f, 1, 1}, {1, 0.5f, 0, 1}}, TextureFilter::nearest);
  Scene scene = painted_wall(paint);
  scene.colours.assign(4, {0.25f, 1, 0.5f, 1});
  Sensor sensor = square_view(2);
  sensor.resolution = {2, 1};
  check_close(reflectivities(monostatic_frame(scene, sensor)),
              {0.2 * 0.125 + 0.5 * 0.25 + 0.3 * 0.5, 0.2 * 0.25 + 0.5 * 0.5});
}

TEST_CASE("a gradient is the same across the edge that two triangles share") {
  Paint paint;
  paint.reflectivity_rgb = {1, 0, 0};
  paint.texture = std::make_shared<const Texture>(Texture{{2, 1}, {grey(0), grey(1)}});
  paint.wrap_u = Wrap::clamp;
  Scene scene = painted_wall(paint);
  // u = 1/4 ... 3/4 along x: the texture's linear part.
  for (glm::dvec2 &coordinates : scene.texture_coordinates)
    coordinates.x = 0.25 + coordinates.x / 2;
  const auto found = reflectivities(monostatic_frame(scene, square_view(9)));
  for (std::size_t pixel = 0; pixel < found.size(); ++pixel)
    CHECK(found[pixel] == Approx((static_cast<double>(pixel % 9) + 0.5) / 9).epsilon(1e-12));
}

TEST_CASE("through a hole in a mask the wall behind is seen") {
  // The texture's middle ninth is open.
  std::vector<glm::vec4> texels(9, grey(1));
  texels[4].a = 0.25f;
  Paint paint = paint_with({3, 3}, texels, TextureFilter::nearest);
  paint.alpha_cutoff = 0.5;
  Scene scene = painted_wall(paint);
  SceneBuilder behind;
  behind.add_wall({3, {0.5}});
  const auto first = static_cast<std::uint32_t>(scene.positions_m.size());
  for (Triangle triangle : behind.scene().triangles) {
    for (std::uint32_t &vertex : triangle.vertices)
      vertex += first;
    scene.triangles.push_back({triangle.vertices, 1, 1});
  }
  scene.positions_m.insert(scene.positions_m.end(), behind.scene().positions_m.begin(),
                           behind.scene().positions_m.end());
  scene.texture_coordinates.resize(scene.positions_m.size());
  scene.surfaces.push_back({0.5});
  scene.objects.push_back("behind");

  Sensor sensor = square_view(1);
  sensor.samples = 12; // 144, of which 16 go through
  sensor.modulation_hz = {1e6};
  const auto frame = monostatic_frame(scene, sensor);
  for (std::uint32_t row = 0; row < 12; ++row)
    for (std::uint32_t column = 0; column < 12; ++column) {
      const bool open = row / 4 == 1 && column / 4 == 1;
      CHECK((frame.sample_triangle_id[row * 12 + column] >= 2) == open);
    }
  CHECK(frame.coverage[0] == 1);
  CHECK(frame.z_m[0] == Approx((128 * 1 + 16 * 3) / 144.0).epsilon(1e-14));
  CHECK(frame.object_id[0] == 1);

  // Without the wall behind the hole sees nothing, and the pixel's centre is in it.
  scene.triangles.resize(2);
  const auto open = monostatic_frame(scene, sensor);
  CHECK(open.coverage[0] == 128 / 144.0);
  CHECK(open.z_m[0] == Approx(1).epsilon(1e-14));
  CHECK(open.triangle_id[0] == no_id);

  // And a view through the hole alone reads the wall's distance.
  Sensor through = axial_sensor();
  scene.triangles.insert(scene.triangles.end(), {{{4, 5, 6}, 1, 1}, {{4, 6, 7}, 1, 1}});
  const auto far = monostatic_frame(scene, through);
  CHECK(far.returns[0].distance_m[0] == Approx(3).epsilon(1e-12));
  CHECK(far.returns[0].amplitude[0] == Approx(0.5 / 9).epsilon(1e-10));
}

TEST_CASE("a mask is there where its alpha is its cutoff, and not where it is below") {
  Paint paint;
  paint.alpha = 0.5;
  paint.alpha_cutoff = 0.25;
  Scene scene = painted_wall(paint, 1.0);
  const auto coverage = [&](float vertex_alpha) {
    scene.colours.assign(4, grey(1, vertex_alpha));
    const auto frame = monostatic_frame(scene, square_view(31));
    return std::accumulate(frame.coverage.begin(), frame.coverage.end(), 0.0) / (31 * 31);
  };
  CHECK(coverage(1.0f) == 1);
  CHECK(coverage(0.5f) == 1); // everywhere: rounding cuts no holes
  CHECK(coverage(std::nextafter(0.5f, 0.0f)) == 0);
}

TEST_CASE("without a cutoff the most transparent surface is there") {
  Paint paint;
  paint.alpha = 0;
  CHECK(monostatic_frame(painted_wall(paint, 1.0), square_view(1)).coverage[0] == 1);
}

TEST_CASE("a mask's edge between vertices is where its alpha crosses the cutoff") {
  Paint paint;
  paint.alpha_cutoff = 0.3;
  Scene scene = painted_wall(paint, 1.0);
  scene.colours = {grey(1, 0), grey(1, 0), grey(1, 1), grey(1, 1)}; // alpha = x + 1/2
  Sensor sensor = square_view(100);
  sensor.resolution = {100, 3};
  const auto frame = monostatic_frame(scene, sensor);
  for (std::size_t pixel = 0; pixel < frame.coverage.size(); ++pixel)
    CHECK(frame.coverage[pixel] == (pixel % 100 >= 30 ? 1 : 0));
}

TEST_CASE("of stacked masks the nearest closed one is seen, whatever their order") {
  Random random(3);
  Paint open, closed;
  open.alpha = 0.4;
  open.alpha_cutoff = closed.alpha_cutoff = 0.5;
  for (int i = 0; i < 50; ++i) {
    SceneBuilder builder;
    double nearest_m = 20;
    builder.add_wall({nearest_m});
    for (int wall = 0; wall < 12; ++wall) {
      const double z_m = random.uniform(1, 10);
      const bool is_open = random.flip() || z_m < 3;
      builder.add_wall({z_m, {1.0, random.flip(), is_open ? open : closed}});
      nearest_m = is_open ? nearest_m : std::min(nearest_m, z_m);
    }
    CHECK(monostatic_frame(builder.scene(), axial_sensor()).range_m[0] == Approx(nearest_m).epsilon(1e-10));
  }
}
