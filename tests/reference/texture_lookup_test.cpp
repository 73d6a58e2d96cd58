// Textures, nearest and linear, by hand: a sampler's rules are glTF's, which are Vulkan's.

#include "engine/reference/view/surface_colours.h"
#include "tests/support/random_scenes.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

// Red is the texel's column, green its row, blue 1 where the sum is odd, alpha halves along the row.
std::shared_ptr<const Texture> numbered_texture(const glm::uvec2 &size) {
  Texture texture{size, {}};
  for (std::uint32_t row = 0; row < size.y; ++row)
    for (std::uint32_t column = 0; column < size.x; ++column)
      texture.texels.emplace_back(column, row, (row + column) % 2,
                                  std::ldexp(1.0, -static_cast<int>(column)));
  return std::make_shared<const Texture>(texture);
}

Paint paint_of(TextureFilter filter, Wrap wrap_u, Wrap wrap_v) {
  Paint paint;
  paint.texture = numbered_texture({4, 2});
  paint.filter = filter;
  paint.wrap_u = wrap_u;
  paint.wrap_v = wrap_v;
  return paint;
}

glm::dvec2 texel_at(TextureFilter filter, Wrap wrap_u, Wrap wrap_v, const glm::dvec2 &coordinates) {
  return reference::texture_colour(paint_of(filter, wrap_u, wrap_v), coordinates);
}

double column_at(TextureFilter filter, Wrap wrap, double u) {
  return texel_at(filter, wrap, Wrap::repeat, {u, 0.25}).x;
}

double row_at(TextureFilter filter, Wrap wrap, double v) {
  return texel_at(filter, Wrap::repeat, wrap, {0.125, v}).y;
}

} // namespace

TEST_CASE("texels are centred at (i + 1/2) / size, columns along u, rows along v") {
  const auto filter = GENERATE(TextureFilter::nearest, TextureFilter::linear);
  const auto wrap = GENERATE(Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp);
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column)
      CHECK(texel_at(filter, wrap, wrap, {(column + 0.5) / 4, (row + 0.5) / 2}) == glm::dvec2(column, row));
}

TEST_CASE("the nearest texel is the one that the place lies in, its lower edge included") {
  const auto [wrap, u, column] = GENERATE(table<Wrap, double, double>({
      {Wrap::repeat, 0.0, 0},
      {Wrap::repeat, 0.2499, 0},
      {Wrap::repeat, 0.25, 1},
      {Wrap::repeat, 0.9999, 3},
      {Wrap::repeat, 1.0, 0},
      {Wrap::repeat, -0.01, 3},
      {Wrap::repeat, -1.3, 2},
      {Wrap::repeat, 7.6, 2},
      {Wrap::repeat, -1.0, 0},
      {Wrap::mirrored_repeat, 0.3, 1},
      {Wrap::mirrored_repeat, 1.0, 3},
      {Wrap::mirrored_repeat, 1.3, 2},
      {Wrap::mirrored_repeat, 1.9, 0},
      {Wrap::mirrored_repeat, 2.1, 0},
      {Wrap::mirrored_repeat, -0.1, 0},
      {Wrap::mirrored_repeat, -0.9, 3},
      {Wrap::mirrored_repeat, -1.1, 3},
      {Wrap::mirrored_repeat, -2.3, 1},
      {Wrap::clamp, 1.0, 3},
      {Wrap::clamp, 25.0, 3},
      {Wrap::clamp, -0.01, 0},
      {Wrap::clamp, -25.0, 0},
      {Wrap::clamp, 0.6, 2},
  }));
  CAPTURE(wrap, u);
  CHECK(column_at(TextureFilter::nearest, wrap, u) == column);
}

TEST_CASE("between texel centres the colour is linear, around the ends as the texture wraps") {
  const auto [wrap, u, column] = GENERATE(table<Wrap, double, double>({
      {Wrap::repeat, 0.25, 0.5},     // between the columns 0 and 1
      {Wrap::repeat, 0.6875, 2.25},  // a quarter from 2 to 3
      {Wrap::repeat, 0.0, 1.5},      // between 3 and 0
      {Wrap::repeat, 0.0625, 0.75},  // three quarters from 3 to 0
      {Wrap::repeat, 0.9375, 2.25},  // a quarter from 3 to 0
      {Wrap::repeat, -0.3125, 2.25}, // as 0.6875
      {Wrap::mirrored_repeat, 0.0, 0},
      /* 0 and 0 */ {Wrap::mirrored_repeat, 1.0, 3},
      {Wrap::mirrored_repeat, 1.0625, 3},    // a quarter from 3 to 3
      {Wrap::mirrored_repeat, 1.1875, 2.75}, // a quarter from 3 to 2
      {Wrap::mirrored_repeat, -0.25, 0.5},   // between 1 and 0
      {Wrap::clamp, 0.0, 0},
      {Wrap::clamp, 0.1, 0},
      {Wrap::clamp, 0.9, 3},
      {Wrap::clamp, 3.1, 3},
      {Wrap::clamp, -3.1, 0},
      {Wrap::clamp, 0.3125, 0.75},
  }));
  CAPTURE(wrap, u);
  CHECK(column_at(TextureFilter::linear, wrap, u) == Approx(column).epsilon(1e-14));
}

TEST_CASE("rows wrap by a rule of their own") {
  CHECK(row_at(TextureFilter::nearest, Wrap::repeat, 1.2) == 0);
  CHECK(row_at(TextureFilter::nearest, Wrap::mirrored_repeat, 1.2) == 1);
  CHECK(row_at(TextureFilter::nearest, Wrap::clamp, -0.2) == 0);
  CHECK(row_at(TextureFilter::linear, Wrap::repeat, 0.0) == 0.5);
  CHECK(row_at(TextureFilter::linear, Wrap::clamp, 1.0) == 1);
  CHECK(texel_at(TextureFilter::nearest, Wrap::clamp, Wrap::repeat, {1.3, 1.3}) == glm::dvec2(3, 0));
  CHECK(texel_at(TextureFilter::nearest, Wrap::repeat, Wrap::clamp, {1.3, 1.3}) == glm::dvec2(1, 1));
}

TEST_CASE("a place among four texels takes each by the area opposite") {
  // A quarter from column 1 to 2, three quarters from row 0 to 1: the checker's blue is 1, 0 / 0, 1.
  const glm::dvec4 colour = reference::texture_colour(
      paint_of(TextureFilter::linear, Wrap::repeat, Wrap::repeat), {(1.5 + 0.25) / 4, (0.5 + 0.75) / 2});
  CHECK(colour.r == Approx(1.25).epsilon(1e-15));
  CHECK(colour.g == Approx(0.75).epsilon(1e-15));
  CHECK(colour.b == Approx(0.75 * 0.25 + 0.25 * 0.75).epsilon(1e-15));
  CHECK(colour.a == Approx(0.75 * 0.5 + 0.25 * 0.25).epsilon(1e-15));
}

TEST_CASE("a texture of one texel is the same everywhere, to the last bit") {
  Paint paint;
  const glm::vec4 colour(0.1f, 0.2f, 0.7f, 0.3f);
  paint.texture = std::make_shared<const Texture>(Texture{{1, 1}, {colour}});
  paint.filter = GENERATE(TextureFilter::nearest, TextureFilter::linear);
  paint.wrap_u = paint.wrap_v = GENERATE(Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp);
  test::Random random(61);
  for (int i = 0; i < 1000; ++i)
    REQUIRE(reference::texture_colour(paint, {random.uniform(-3, 3), random.uniform(-1e6, 1e6)}) ==
            glm::dvec4(colour));
}

TEST_CASE("coordinates beyond every integer still find a texel") {
  const auto filter = GENERATE(TextureFilter::nearest, TextureFilter::linear);
  const auto wrap = GENERATE(Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp);
  for (const double u : {1e15, -1e15, 3.4e38, -3.4e38}) {
    const double column = column_at(filter, wrap, u);
    CHECK((column >= 0 && column <= 3));
  }
}
