#include "engine/model/scene.h"
#include "host/output/pictures/key.h"
#include "host/output/pictures/preview.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/nan_value.h"
#include "tests/host/output/pixel_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

using namespace pmdsim;
using namespace pmdsim::test;
using pmdsim::test::count_pixels;

namespace {

using Scale = ColourScale;

int area_of(Canvas &canvas, std::uint32_t colour) {
  return count_pixels(canvas, [=](std::uint32_t pixel) { return pixel == colour; });
}

constexpr std::uint32_t grey = 0x8c8c8c; // no_value_colour

} // namespace

TEST_CASE("large frames shrink to 1024 pixels a side, small ones grow by whole factors") {
  const std::vector<float> large(4096 * 3000), edge(1025), small(6 * 4), medium(640 * 480);
  CHECK(preview_image(large, {4096, 3000}, Scale::sequential).resolution == glm::uvec2(1024, 750));
  CHECK(preview_image(large, {4096, 3000}, Scale::sequential).enlargement == 1);
  CHECK(preview_image(edge, {1, 1025}, Scale::sequential).resolution == glm::uvec2(1, 513));
  CHECK(preview_image(small, {6, 4}, Scale::sequential).resolution == glm::uvec2(6, 4));
  CHECK(preview_image(small, {6, 4}, Scale::sequential).enlargement == 85);
  CHECK(preview_image(medium, {640, 480}, Scale::sequential).enlargement == 1);
}

TEST_CASE("shrinking averages what has a value; of angles it takes one") {
  std::vector<float> values(2048, 1.0f);
  values[1] = 3.0f;
  values[2] = nan_value;
  values[4] = values[5] = nan_value;
  const PreviewImage mean = preview_image(values, {2048, 1}, Scale::sequential);
  CHECK(mean.values[0] == 2.0f);
  CHECK(mean.values[1] == 1.0f);
  CHECK(std::isnan(mean.values[2]));
  CHECK(preview_image(values, {2048, 1}, Scale::turn).values[0] == 1.0f);
}

TEST_CASE("a preview shows its pixels' colours, and grey with a legend where there is no value") {
  const Preview preview{"deformation", Scale::zero_centred};
  Canvas full = draw_preview(std::vector{-1.0f, 1.0f}, {2, 1}, preview, "mm", "title");
  constexpr int pixel_area = 256 * 256;
  CHECK(area_of(full, 0x00509b) >= pixel_area);
  CHECK(area_of(full, 0x8e240f) >= pixel_area);
  CHECK(area_of(full, grey) < 100); // of the edges of letters
  Canvas gap = draw_preview(std::vector{-1.0f, nan_value, 1.0f}, {3, 1}, preview, "mm", "title");
  CHECK(area_of(gap, 0x00509b) >= 170 * 170);
  CHECK(area_of(gap, grey) >= 170 * 170 + 13 * 13);
}

TEST_CASE("shares have the colours of a scale from 0 to 1, whatever is in the frame") {
  const Preview preview{"lit", Scale::share};
  Canvas none = draw_preview(std::vector{0.0f, 0.0f}, {2, 1}, preview, "", "title");
  CHECK(area_of(none, 0x440154) >= 2 * 256 * 256);
  Canvas all = draw_preview(std::vector{1.0f, 1.0f}, {2, 1}, preview, "", "title");
  CHECK(area_of(all, 0xfde725) >= 2 * 256 * 256);
}

TEST_CASE("an image of one value has no bar, but the value's colour in its legend") {
  const Preview preview{"deformation", Scale::zero_centred};
  constexpr int image_area = 2 * 256 * 256, swatch_area = 13 * 13;
  Canvas constant = draw_preview(std::vector{2.632f, 2.632f}, {2, 1}, preview, "mm", "title");
  CHECK(area_of(constant, 0x21908d) >= image_area); // the middle of the map
  CHECK(area_of(constant, 0x21908d) + area_of(constant, 0x20908d) >= image_area + swatch_area);
  CHECK(area_of(constant, 0x440154) == 0); // an end of it
  CHECK(area_of(constant, grey) < 100);
  Canvas gap = draw_preview(std::vector{2.632f, nan_value}, {2, 1}, preview, "mm", "title");
  CHECK(area_of(gap, grey) >= image_area / 2 + swatch_area);
  Canvas none = draw_preview(std::vector{nan_value, nan_value}, {2, 1}, preview, "mm", "title");
  CHECK(area_of(none, grey) >= image_area + swatch_area);
}

TEST_CASE("ids have a colour each, in the image and in the legend") {
  Canvas canvas = draw_preview(std::vector<std::uint32_t>{0, 1, 1, no_id}, {4, 1}, "title");
  constexpr int pixel_area = 128 * 128, swatch_area = 13 * 13;
  CHECK(area_of(canvas, 0x2e78b5) >= pixel_area + swatch_area);
  CHECK(area_of(canvas, 0xf59e38) >= 2 * pixel_area + swatch_area);
  CHECK(area_of(canvas, grey) >= pixel_area + swatch_area);
}

TEST_CASE("the legend has the names of ids") {
  const std::vector<std::uint32_t> ids{0, 1, 1, no_id};
  const std::string longest(200, 'm');
  const auto width_with = [&](const std::vector<std::string> &names) {
    return draw_preview(ids, {4, 1}, "title", names).width();
  };
  const int without = draw_preview(ids, {4, 1}, "title").width();
  CHECK(width_with({"wall", "a ball before the wall, green"}) > without);
  CHECK(width_with({longest, longest}) == width_with({longest.substr(0, 40), longest.substr(0, 40)}));
}

TEST_CASE("of many ids the legend names a few") {
  std::vector<std::uint32_t> ids(1000);
  std::iota(ids.begin(), ids.end(), 0u);
  const Canvas canvas = draw_preview(ids, {1000, 1}, "title");
  CHECK(canvas.height() < 400);
}

TEST_CASE("values for people") {
  CHECK(value_text(2.63249) == "2.632");
  CHECK(value_text(-0.0) == "0");
  CHECK(value_text(-1.5e-7) == "−1.5e−07");
}

TEST_CASE("frames of extreme shapes can be drawn") {
  const Preview preview{"distance", Scale::sequential};
  for (const glm::uvec2 resolution : {glm::uvec2(1, 1), glm::uvec2(3000, 1), glm::uvec2(1, 3000)}) {
    const std::vector<float> values(std::size_t{resolution.x} * resolution.y, 2.0f);
    const Canvas canvas = draw_preview(values, resolution, preview, "m", "title");
    CHECK(canvas.width() < 1400);
    CHECK(canvas.height() < 1400);
  }
}

TEST_CASE("a preview is written as PNG") {
  const pmdsim::test::TemporaryFolder temporary;
  OutputFile file(temporary.path() / "preview.png");
  draw_preview(std::vector{1.0f}, {1, 1}, {"distance", Scale::sequential}, "m", "title").write_png(file);
  file.close();
  file.publish();
  const std::string bytes = content_of(file.path());
  CHECK(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  CHECK(bytes.find("IEND") == bytes.size() - 8);
}
