// Pictures of whole runs and what records keep for them.

#include "host/output/run/frame_records.h"
#include "host/output/run/run_identity.h"
#include "host/output/sheets/animation.h"
#include "host/output/sheets/contact_sheet.h"
#include "host/output/sheets/sheets.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/nan_value.h"
#include "tests/host/output/pixel_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <libdeflate.h>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::ordered_json;

namespace {

Thumbnail thumbnail_of(const std::vector<float> &values, const glm::uvec2 &resolution) {
  const ChannelSet set{
      resolution,
      {{"distance_m", "m", std::span(values), std::nullopt, Preview{"distance", ColourScale::sequential}}}};
  return thumbnails_of(set).at(0);
}

std::uint32_t number_at(const std::string &bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

struct Chunk {
  std::string type, content;
};

// All chunks, whose checksums must be right.
std::vector<Chunk> chunks_of(const std::string &png) {
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t length = number_at(png, at);
    chunks.push_back({png.substr(at + 4, 4), png.substr(at + 8, length)});
    CHECK(number_at(png, at + 8 + length) == libdeflate_crc32(0, png.data() + at + 4, length + 4));
    at += 12 + length;
  }
  return chunks;
}

// Of an image of three bytes a pixel.
std::string inflated(const std::string &data, int width, int height) {
  std::string rows(static_cast<std::size_t>(height) * (1 + 3 * static_cast<std::size_t>(width)), '\0');
  libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
  CHECK(libdeflate_zlib_decompress(decompressor, data.data(), data.size(), rows.data(), rows.size(),
                                   nullptr) == LIBDEFLATE_SUCCESS);
  libdeflate_free_decompressor(decompressor);
  return rows;
}

std::string data_of(const std::string &png) {
  std::string data;
  for (const Chunk &chunk : chunks_of(png))
    if (chunk.type == "IDAT")
      data += chunk.content;
  return data;
}

void write_text(const std::filesystem::path &file, const std::string &text) { std::ofstream(file) << text; }

// The names of the pictures of a run of two frames, whose records keep so many thumbnails.
std::vector<std::string> sheets_of_edited_run(std::size_t thumbnails) {
  const TemporaryFolder folder;
  const RunIdentity run{{{"setup", {{"frames", {{"count", 2}}}}}}, "a"};
  write_text(folder.path() / run_file_name, run_file_text(run, this_process()));
  const ordered_json one = thumbnail_json(thumbnail_of({1, 2}, {2, 1}));
  for (const std::uint32_t frame : {0u, 1u}) {
    FrameRecord record;
    record.sensor.name = "pmd";
    record.frame = frame;
    record.thumbnails = ordered_json::array();
    for (std::size_t i = 0; i < thumbnails; ++i) {
      record.thumbnails.push_back(one);
      record.thumbnails.back()["channel"] = "f" + std::to_string(i);
    }
    write_text(folder.path() / record_name(frame), record_json(run.hash, {record}).dump());
  }
  return write_sheets(folder.path(), [] {});
}

} // namespace

TEST_CASE("records that were given thumbnails of more channels than sensors have get no pictures") {
  CHECK(sheets_of_edited_run(2) ==
        std::vector<std::string>{"pmd.f0.sheet.png", "pmd.f0.apng", "pmd.f1.sheet.png", "pmd.f1.apng"});
  CHECK(sheets_of_edited_run(4097).empty());
}

TEST_CASE("pictures of a run show all frames of a few, and 36 of many, the first and the last among them") {
  CHECK_FALSE(is_in_sheets(0, 1));
  for (const std::uint32_t count : {2u, 5u, 36u, 37u, 71u, 1000u, 100'000u}) {
    std::uint32_t shown = 0, last = 0, widest = 0;
    for (std::uint32_t frame = 0; frame < count; ++frame)
      if (is_in_sheets(frame, count)) {
        widest = std::max(widest, frame - last);
        last = frame;
        ++shown;
      }
    CHECK(shown == std::min(count, 36u));
    CHECK(is_in_sheets(0, count));
    CHECK(last == count - 1);
    CHECK(widest <= (count - 1) / (shown - 1) + 1);
  }
}

TEST_CASE("a thumbnail comes back from a record within a part in 4094 of its range, gaps as gaps") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> metres(2.0f, 6.0f);
  std::vector<float> values(150 * 40);
  for (float &value : values)
    value = metres(random);
  values[0] = values[1] = values[150] = values[151] = nan_value;
  const Thumbnail before = thumbnail_of(values, {150, 40});
  CHECK(before.image.resolution == glm::uvec2(75, 20));
  const auto after = parsed_thumbnail(ordered_json::parse(thumbnail_json(before).dump()));
  REQUIRE(after);
  CHECK(after->channel == "distance_m");
  CHECK(after->unit == "m");
  CHECK(after->frame_resolution == glm::uvec2(150, 40));
  const Range range = spread_of_values(before.image.values).robust;
  for (std::size_t i = 0; i < before.image.values.size(); ++i) {
    const auto expected = std::clamp(static_cast<double>(before.image.values[i]), range.min, range.max);
    if (std::isnan(before.image.values[i]))
      CHECK(std::isnan(after->image.values[i]));
    else
      CHECK(std::abs(static_cast<double>(after->image.values[i]) - expected) <= range.span() / 8000.0);
  }
}

TEST_CASE("constant and empty thumbnails come back") {
  for (const float value : {0.0f, 2.5f, nan_value}) {
    const auto after = parsed_thumbnail(thumbnail_json(thumbnail_of({value, value}, {2, 1})));
    REQUIRE(after);
    CHECK((after->image.values[0] == value || std::isnan(value)));
  }
}

TEST_CASE("what is no thumbnail any more is refused") {
  const ordered_json good = thumbnail_json(thumbnail_of({1.0f, 2.0f}, {2, 1}));
  REQUIRE(parsed_thumbnail(good));
  const std::vector<std::pair<const char *, ordered_json>> edits{{"values", "AAA"},
                                                                 {"values", "AA!A"},
                                                                 {"values", 3},
                                                                 {"resolution", {2, 2}},
                                                                 {"resolution", {0, 1}},
                                                                 {"resolution", {-2, 1}},
                                                                 {"resolution", {1'000'000, 1}},
                                                                 {"resolution", "2"},
                                                                 {"range", {1.0}},
                                                                 {"range", {2.0, 1.0}},
                                                                 {"range", {1e300, 1e301}},
                                                                 {"range", {-1e39, 1.0}},
                                                                 {"range", {nullptr, 1}},
                                                                 {"channel", ""},
                                                                 {"channel", std::string(1000, 'x')},
                                                                 {"unit", 7},
                                                                 {"frame_resolution", {0, 0}}};
  for (const auto &[key, value] : edits) {
    ordered_json edited = good;
    edited[key] = value;
    INFO(edited.dump().substr(0, 300));
    CHECK_FALSE(parsed_thumbnail(edited));
    edited.erase(key);
    CHECK_FALSE(parsed_thumbnail(edited));
  }
  CHECK_FALSE(parsed_thumbnail(nullptr));
  CHECK_FALSE(parsed_thumbnail("text"));
}

TEST_CASE("all frames of a contact sheet have the same colours") {
  FilmStrip strip{"pmd", {0, 1}, {thumbnail_of({0.0f, 1.0f}, {2, 1}), thumbnail_of({1.0f, 2.0f}, {2, 1})}};
  CHECK(colouring_of(strip).range.max == Approx(2.0));
  Canvas sheet = draw_contact_sheet(strip, 2);
  constexpr int pixel_area = 80 * 80;
  const int middle = count_pixels(sheet, [](std::uint32_t pixel) { return pixel == 0x21908d; });
  CHECK(middle >= 2 * pixel_area); // the value 1 in both frames
  for (std::uint32_t frame = 2; frame < 36; ++frame) {
    strip.frames.push_back(frame);
    strip.thumbnails.push_back(strip.thumbnails[frame % 2]);
  }
  CHECK(draw_contact_sheet(strip, 36).width() < 1400);
}

TEST_CASE("an animation has the pixels of each of its images") {
  const TemporaryFolder temporary;
  OutputFile file(temporary.path() / "moving.apng");
  AnimatedPng animation(file, 3, 250);
  std::vector<std::string> rows;
  for (int i = 0; i < 3; ++i) {
    Canvas canvas(300, 200);
    canvas.fill({10.0 + 50.0 * i, 20.0, 40.0, 40.0}, black);
    rows.push_back(inflated(data_of(canvas.png()), 300, 200));
    animation.add(canvas);
  }
  animation.end();
  file.close();
  file.publish();
  const std::vector<Chunk> chunks = chunks_of(content_of(file.path()));
  std::vector<std::string> types;
  for (const Chunk &chunk : chunks)
    types.push_back(chunk.type);
  CHECK(types ==
        std::vector<std::string>{"IHDR", "acTL", "fcTL", "IDAT", "fcTL", "fdAT", "fcTL", "fdAT", "IEND"});
  CHECK(number_at(chunks[1].content, 0) == 3);
  const std::vector<std::pair<int, int>> numbered{{2, 0}, {4, 1}, {5, 2}, {6, 3}, {7, 4}};
  for (const auto &[chunk, number] : numbered)
    CHECK(number_at(chunks[static_cast<std::size_t>(chunk)].content, 0) ==
          static_cast<std::uint32_t>(number));
  CHECK(chunks[2].content.size() == 26);
  CHECK(number_at(chunks[2].content, 4) == 300);
  CHECK(number_at(chunks[2].content, 8) == 200);
  CHECK(inflated(chunks[3].content, 300, 200) == rows[0]);
  CHECK(inflated(chunks[5].content.substr(4), 300, 200) == rows[1]);
  CHECK(inflated(chunks[7].content.substr(4), 300, 200) == rows[2]);
}

TEST_CASE("an animation whose images differ in size or number is a mistake of the program") {
  const TemporaryFolder temporary;
  OutputFile file(temporary.path() / "moving.apng");
  AnimatedPng animation(file, 2, 250);
  animation.add(Canvas(30, 20));
  CHECK_THROWS_AS(animation.end(), std::logic_error);
  CHECK_THROWS_AS(animation.add(Canvas(31, 20)), std::logic_error);
}
