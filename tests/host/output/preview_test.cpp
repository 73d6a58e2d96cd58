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

TEST_CASE("the range leaves outliers out and suits its scale") {
  std::vector<float> values(1001);
  std::iota(values.begin(), values.end(), 0.0f);
  values.back() = 1e9f;
  CHECK(preview_range(values, Scale::sequential).min == 5.0);
  CHECK(preview_range(values, Scale::sequential).max == 995.0);
  CHECK(preview_range(values, Scale::zero_centred).min == -995.0);
  CHECK(preview_range(values, Scale::zero_centred).max == 995.0);
  CHECK(preview_range(values, Scale::turn).max == Approx(6.283185307));
  CHECK(preview_range(values, Scale::share).min == 0.0);
  CHECK(preview_range(values, Scale::share).max == 1.0);
}

TEST_CASE("constant and empty images have a range of some extent about their value") {
  for (const float value : {0.0f, 2.0f, -1e-20f, 1e20f, nan_value})
    for (const Scale scale : {Scale::sequential, Scale::zero_centred, Scale::turn}) {
      const Range range = preview_range(std::vector{value, value}, scale);
      CHECK(range.span() > 0.0);
      if (scale == Scale::sequential && !std::isnan(value))
        CHECK(0.5 * (range.min + range.max) == Approx(static_cast<double>(value)));
    }
}

TEST_CASE("a preview shows its pixels' colours, and grey with a legend where there is no value") {
  const Preview preview{"deformation", Scale::zero_centred};
  Canvas full = draw_preview(std::vector{-1.0f, 1.0f}, {2, 1}, preview, "mm", "title");
  constexpr int pixel_area = 256 * 256;
  CHECK(area_of(full, 0x00509b) >= pixel_area);
  CHECK(area_of(full, 0x8e240f) >= pixel_area);
  CHECK(area_of(full, grey) < 100); // of the edges of letters
  Canvas gap = draw_preview(std::vector{-1.0f, nan_value}, {2, 1}, preview, "mm", "title");
  CHECK(area_of(gap, 0x00509b) >= pixel_area);
  CHECK(area_of(gap, grey) >= pixel_area + 14 * 14);
}

TEST_CASE("shares have the colours of a scale from 0 to 1, whatever is in the frame") {
  const Preview preview{"lit", Scale::share};
  Canvas none = draw_preview(std::vector{0.0f, 0.0f}, {2, 1}, preview, "", "title");
  CHECK(area_of(none, 0x440154) >= 2 * 256 * 256);
  Canvas all = draw_preview(std::vector{1.0f, 1.0f}, {2, 1}, preview, "", "title");
  CHECK(area_of(all, 0xfde725) >= 2 * 256 * 256);
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
