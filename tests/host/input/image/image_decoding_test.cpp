// PNG and JPEG images become linear texels; broken ones are refused in one line.

#include "host/input/image/image_pixels.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/host/input/image/image_bytes.h"

#include <cmath>
#include <fmt/format.h>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;

namespace {

const Place place = Place{"scene.gltf"} / "images" / 2;
constexpr std::size_t pixels_allowed = 1u << 20;

ImagePixels decoded(const std::string &bytes, std::size_t max_pixels = pixels_allowed) {
  return decoded_image({reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size()}, max_pixels,
                       place);
}

std::string error_of(const std::string &bytes, std::size_t max_pixels = pixels_allowed) {
  return input_error_of([&] { decoded(bytes, max_pixels); });
}

using Components = std::vector<unsigned char>;

Components rgba_of(const PngImage &image) { return decoded(png_bytes(image)).rgba; }

PngImage noise(int bits, int colour_type, std::size_t row_bytes) {
  std::mt19937 random(20070605);
  PngImage image{9, 7, bits, colour_type};
  for (std::size_t i = 0; i < 7 * row_bytes; ++i)
    image.rows.push_back(static_cast<std::uint8_t>(random()));
  return image;
}

std::string with_byte(std::string bytes, std::size_t offset, char byte) {
  bytes.at(offset) = byte;
  return bytes;
}

constexpr std::size_t after_header = 33; // of a PNG: the signature and IHDR

const std::string good_png = png_bytes({2, 2, 8, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}});
const std::string good_jpeg = jpeg_bytes(16, 16, std::vector<std::uint8_t>(16 * 16 * 3, 77));

} // namespace

TEST_CASE("PNG of 8 bits in every colour type") {
  CHECK(rgba_of({2, 1, 8, 0, {10, 200}}) == Components{10, 10, 10, 255, 200, 200, 200, 255});
  CHECK(rgba_of({1, 2, 8, 2, {1, 2, 3, 4, 5, 6}}) == Components{1, 2, 3, 255, 4, 5, 6, 255});
  CHECK(rgba_of({2, 1, 8, 3, {1, 0}, {1, 2, 3, 4, 5, 6}}) == Components{4, 5, 6, 255, 1, 2, 3, 255});
  CHECK(rgba_of({2, 1, 8, 4, {10, 20, 30, 40}}) == Components{10, 10, 10, 20, 30, 30, 30, 40});
  CHECK(rgba_of({1, 1, 8, 6, {1, 2, 3, 4}}) == Components{1, 2, 3, 4});
}

TEST_CASE("PNG of 1, 2 and 4 bits") {
  CHECK(rgba_of({2, 1, 1, 0, {0b0100'0000}}) == Components{0, 0, 0, 255, 255, 255, 255, 255});
  CHECK(rgba_of({2, 1, 2, 0, {0b0110'0000}}) == Components{85, 85, 85, 255, 170, 170, 170, 255});
  CHECK(rgba_of({2, 1, 4, 0, {0x3f}}) == Components{51, 51, 51, 255, 255, 255, 255, 255});
  CHECK(rgba_of({2, 1, 4, 3, {0x10}, {1, 2, 3, 4, 5, 6}}) == Components{4, 5, 6, 255, 1, 2, 3, 255});
}

TEST_CASE("PNG of 16 bits keeps them") {
  const ImagePixels grey = decoded(png_bytes({1, 1, 16, 0, {0x12, 0x34}}));
  CHECK(grey.component_bytes == 2);
  CHECK(grey.rgba == Components{0x12, 0x34, 0x12, 0x34, 0x12, 0x34, 0xff, 0xff});
  const std::vector<std::uint8_t> rgba = {0, 1, 2, 3, 4, 5, 6, 7};
  CHECK(rgba_of({1, 1, 16, 6, rgba}) == rgba);
  CHECK(rgba_of({1, 1, 16, 2, {0, 1, 2, 3, 4, 5}}) == Components{0, 1, 2, 3, 4, 5, 0xff, 0xff});
}

TEST_CASE("PNG with tRNS") {
  CHECK(rgba_of({.width = 2,
                 .bits = 8,
                 .colour_type = 3,
                 .rows = {0, 1},
                 .palette = {1, 2, 3, 4, 5, 6},
                 .palette_alpha = {9}}) == Components{1, 2, 3, 9, 4, 5, 6, 255});
  CHECK(rgba_of({.width = 2, .bits = 8, .colour_type = 0, .rows = {7, 8}, .transparent = {8}}) ==
        Components{7, 7, 7, 255, 8, 8, 8, 0});
  CHECK(rgba_of({.width = 2, .rows = {1, 2, 3, 1, 2, 4}, .transparent = {1, 2, 3}}) ==
        Components{1, 2, 3, 0, 1, 2, 4, 255});
}

TEST_CASE("PNG interlaced is the same image") {
  for (PngImage image : {noise(8, 2, 27), noise(16, 6, 72), noise(1, 0, 2)}) {
    const Components plain = rgba_of(image);
    image.interlaced = true;
    CHECK(rgba_of(image) == plain);
  }
}

TEST_CASE("PNG chunks about colour change nothing") {
  PngImage image{1, 1, 8, 2, {50, 100, 200}};
  const Components plain = rgba_of(image);
  image.gamma = 1.0;
  CHECK(png_bytes(image).find("gAMA") != std::string::npos);
  CHECK(rgba_of(image) == plain);
  std::string profiled = good_png;
  profiled.insert(after_header, png_chunk("sRGB", std::string(1, '\0')) + png_chunk("iCCP", "nonsense"));
  CHECK(decoded(profiled).rgba == decoded(good_png).rgba);
}

TEST_CASE("JPEG in colour and grey") {
  std::vector<std::uint8_t> colour;
  for (int i = 0; i < 16 * 8; ++i)
    colour.insert(colour.end(), {200, 100, 50});
  const ImagePixels pixels = decoded(jpeg_bytes(16, 8, colour));
  CHECK(pixels.size == glm::uvec2(16, 8));
  CHECK(pixels.component_bytes == 1);
  REQUIRE(pixels.rgba.size() == 16 * 8 * 4);
  for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
    // Through YCbCr in whole numbers and back: 1 off at most.
    CHECK(std::abs(pixels.rgba[i] - 200) <= 1);
    CHECK(std::abs(pixels.rgba[i + 1] - 100) <= 1);
    CHECK(std::abs(pixels.rgba[i + 2] - 50) <= 1);
    CHECK(pixels.rgba[i + 3] == 255);
  }
  const ImagePixels grey = decoded(jpeg_bytes(8, 8, std::vector<std::uint8_t>(64, 77), JpegColours::grey));
  CHECK(Components(grey.rgba.begin(), grey.rgba.begin() + 4) == Components{77, 77, 77, 255});
}

TEST_CASE("JPEG's first row is the top one") {
  std::vector<std::uint8_t> pixels(8 * 16, 10);
  std::fill(pixels.begin() + 64, pixels.end(), std::uint8_t{240});
  const ImagePixels decoded_pixels = decoded(jpeg_bytes(8, 16, pixels, JpegColours::grey));
  CHECK(decoded_pixels.rgba.front() == 10);
  CHECK(decoded_pixels.rgba[8 * 16 * 4 - 4] == 240);
}

TEST_CASE("JPEG that is progressive is the same image") {
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < 24 * 24 * 3; ++i)
    pixels.push_back(static_cast<std::uint8_t>(i * i / 37));
  CHECK(decoded(jpeg_bytes(24, 24, pixels, JpegColours::rgb, true)).rgba ==
        decoded(jpeg_bytes(24, 24, pixels)).rgba);
}

TEST_CASE("JPEG's EXIF orientation changes nothing") {
  // APP1: a TIFF of one entry, orientation 6 (turned by 90 degrees).
  const std::string exif("\xff\xe1\x00\x22"
                         "Exif\0\0MM\0\x2a\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0",
                         36);
  std::string turned = good_jpeg;
  turned.insert(2, exif);
  CHECK(decoded(turned).rgba == decoded(good_jpeg).rgba);
}

TEST_CASE("Stored numbers become linear light by the sRGB formula, alpha stays") {
  for (int stored = 0; stored < 256; ++stored) {
    const double c = stored / 255.0;
    const double expected = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    const auto byte = static_cast<unsigned char>(stored);
    const Texture texture = linear_texture({{1, 1}, 1, {byte, 0, 255, byte}});
    CHECK(texture.texels.at(0).r == Approx(expected).epsilon(1e-7));
    CHECK(texture.texels.at(0).g == 0.0f);
    CHECK(texture.texels.at(0).b == 1.0f);
    CHECK(texture.texels.at(0).a == Approx(c).epsilon(1e-7));
  }
  CHECK(linear_from_srgb(0.5) == Approx(0.21404114048).epsilon(1e-10)); // IEC 61966-2-1
  CHECK(linear_from_srgb(0.04045) == Approx(0.0031308).epsilon(1e-4));
}

TEST_CASE("16 bits become linear light at their own precision") {
  const Texture texture = linear_texture({{1, 1}, 2, {0x80, 0x01, 0x00, 0x01, 0xff, 0xff, 0x40, 0x00}});
  CHECK(texture.texels.at(0).r == Approx(std::pow((0x8001 / 65535.0 + 0.055) / 1.055, 2.4)).epsilon(1e-7));
  CHECK(texture.texels.at(0).g == Approx(1.0 / 65535.0 / 12.92).epsilon(1e-7));
  CHECK(texture.texels.at(0).b == 1.0f);
  CHECK(texture.texels.at(0).a == Approx(0x4000 / 65535.0).epsilon(1e-7));
}

TEST_CASE("Rows of texels keep their order") {
  const Texture texture = linear_texture(decoded(png_bytes({2, 2, 8, 4, {0, 1, 0, 2, 0, 3, 0, 4}})));
  CHECK(texture.size == glm::uvec2(2, 2));
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(texture.texels.at(i).a == Approx(static_cast<double>(i + 1) / 255.0).epsilon(1e-7));
}

TEST_CASE("What is neither PNG nor JPEG") {
  const std::string expected = "scene.gltf: /images/2: expected a PNG or JPEG image, found neither";
  for (const std::string bytes : {"", "GIF89a", "RIFF\x10\0\0\0WEBP", "\x89PNG", "\xff\xd8"})
    CHECK(error_of(bytes) == expected);
}

TEST_CASE("PNG that is broken") {
  const std::string no_png = "scene.gltf: /images/2: no valid PNG: ";
  CHECK(error_of(good_png.substr(0, 8)) == no_png + "the image is cut short");
  CHECK(error_of(good_png.substr(0, after_header)) == no_png + "the image is cut short");
  CHECK(error_of(good_png.substr(0, good_png.size() - 20)) == no_png + "the image is cut short");
  CHECK(error_of(good_png.substr(0, good_png.size() - 1)) == no_png + "the image is cut short");
  CHECK_THAT(error_of(with_byte(good_png, after_header + 12, '\x55')), Contains(no_png)); // IDAT's bytes
  CHECK_THAT(error_of(with_byte(good_png, 16, '\1')), Contains(no_png + "IHDR: CRC error"));
  CHECK_THAT(error_of(good_png.substr(0, after_header) + png_chunk("IEND", "")), Contains(no_png));
  CHECK_THAT(
      error_of(good_png.substr(0, after_header) + png_chunk("IDAT", "nonsense") + png_chunk("IEND", "")),
      Contains(no_png));
  CHECK_THAT(error_of(png_header(0, 5)), Contains(no_png + "Invalid IHDR data"));
  const std::string no_palette =
      "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", std::string("\0\0\0\1\0\0\0\1\x08\3\0\0\0", 13));
  CHECK_THAT(error_of(no_palette + png_chunk("IDAT", "x")), Contains(no_png));
}

TEST_CASE("PNG with fewer rows than stated") {
  // The rows of a 2 x 2 image under a header of 2 x 3.
  std::string bytes = good_png;
  const std::string taller = png_chunk("IHDR", std::string("\0\0\0\2\0\0\0\3\x08\2\0\0\0", 13));
  bytes.replace(8, taller.size(), taller);
  CHECK_THAT(error_of(bytes), Contains("no valid PNG: "));
}

TEST_CASE("Images of too large a size are refused at their header") {
  CHECK(error_of(png_header(16385, 1)) ==
        "scene.gltf: /images/2: expected at most 16384 pixels a side, found an image of 16385 x 1");
  CHECK_THAT(error_of(png_header(2147483647, 2147483647)),
             EndsWith("found an image of 2147483647 x 2147483647"));
  CHECK_THAT(error_of(png_header(1, 2147483648u)), Contains("no valid PNG"));
  CHECK(error_of(png_header(16384, 16384), std::size_t{1} << 27) ==
        "scene.gltf: /images/2: expected at most 134217728 further pixels, found an image of 16384 x 16384");
  CHECK_THAT(error_of(good_png, 3), EndsWith("expected at most 3 further pixels, found an image of 2 x 2"));
  CHECK(decoded(good_png, 4).size == glm::uvec2(2, 2));
  std::string tall = good_jpeg;
  const std::size_t frame = tall.find("\xff\xc0");
  tall[frame + 5] = '\xff'; // the height's more significant byte
  CHECK_THAT(error_of(tall), EndsWith("expected at most 16384 pixels a side, found an image of 16 x 65296"));
}

TEST_CASE("JPEG that is broken") {
  const std::string no_jpeg = "scene.gltf: /images/2: no valid JPEG: ";
  CHECK_THAT(error_of(good_jpeg.substr(0, 3)), Contains(no_jpeg));
  CHECK_THAT(error_of(good_jpeg.substr(0, 40)), Contains(no_jpeg));
  CHECK_THAT(error_of(good_jpeg.substr(0, good_jpeg.size() - 2)), Contains(no_jpeg));
  CHECK_THAT(error_of(good_jpeg.substr(0, good_jpeg.size() - 10)), Contains(no_jpeg));
  CHECK(error_of(jpeg_bytes(8, 8, std::vector<std::uint8_t>(256, 77), JpegColours::cmyk)) ==
        "scene.gltf: /images/2: expected a JPEG in grey or colour, found CMYK");
}

TEST_CASE("Damaged images load or are refused in one line") {
  std::mt19937 random(20070605);
  int refused = 0;
  const std::string interlaced = [] {
    PngImage image = noise(8, 6, 36);
    image.interlaced = true;
    return png_bytes(image);
  }();
  for (const std::string &good : {interlaced, good_jpeg})
    for (int trial = 0; trial < 600; ++trial) {
      std::string bytes = good;
      if (trial % 2 == 0)
        bytes.resize(random() % bytes.size());
      else
        bytes[random() % bytes.size()] ^= static_cast<char>(1u << random() % 8);
      try {
        decoded(bytes);
      } catch (const Error &error) {
        ++refused;
        REQUIRE(error.code() == ExitCode::input);
        REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
      }
    }
  CHECK(refused > 600);
}
