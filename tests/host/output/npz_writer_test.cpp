#include "engine/model/error.h"
#include "engine/model/scene.h"
#include "host/output/files/channel.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/file_size_limit.h"
#include "tests/support/temporary_folder.h"

#include <archive.h>
#include <archive_entry.h>
#include <bit>
#include <catch2/catch.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

constexpr glm::uvec2 npz_resolution{37, 11};

// Two channels of bits, all kinds of NaN among them, and ids.
struct NpzFrame {
  NpzFrame() : distances(npz_resolution.x * npz_resolution.y), ids(distances.size(), no_id) {
    for (std::size_t i = 0; i < distances.size(); ++i)
      distances[i] = std::bit_cast<float>(static_cast<std::uint32_t>(0x7fc00000u + 977u * i));
    ids[5] = 7;
  }
  ChannelSet channels() const {
    return {npz_resolution,
            {{"distance_m", "m", std::span(distances), 1}, {"object_id", "", std::span(ids)}}};
  }

  std::vector<float> distances;
  std::vector<std::uint32_t> ids;
};

void write_npz_to(const std::filesystem::path &path, const ChannelSet &channels) {
  OutputFile file(path);
  write_npz(file, channels);
  file.close();
  file.publish();
}

// The contents of the archive's files, which are all stored as they are, as libarchive reads them: it checks
// their checksums.
std::map<std::string, std::string> unpacked(const std::filesystem::path &path) {
  const std::unique_ptr<archive, decltype([](archive *of) { archive_read_free(of); })> zip(
      archive_read_new());
  REQUIRE(archive_read_support_format_zip(zip.get()) == ARCHIVE_OK);
  REQUIRE(archive_read_open_filename(zip.get(), path.c_str(), 1 << 16) == ARCHIVE_OK);
  std::map<std::string, std::string> files;
  archive_entry *entry = nullptr;
  while (archive_read_next_header(zip.get(), &entry) == ARCHIVE_OK) {
    std::string &content = files[archive_entry_pathname(entry)];
    content.resize(static_cast<std::size_t>(archive_entry_size(entry)));
    CHECK(archive_read_data(zip.get(), content.data(), content.size()) ==
          static_cast<la_ssize_t>(content.size()));
    CHECK(archive_read_data(zip.get(), content.data(), 1) == 0);
    CHECK(std::string(archive_format_name(zip.get())).find("uncompressed") != std::string::npos);
  }
  return files;
}

std::string npy_of(const Channel &channel) {
  const pmdsim::test::TemporaryFolder temporary;
  OutputFile file(temporary.path() / "array.npy");
  write_npy(file, channel, npz_resolution);
  file.close();
  file.publish();
  return content_of(file.path());
}

} // namespace

TEST_CASE("NumPy's archive has every channel as the array that its own file would be") {
  const pmdsim::test::TemporaryFolder temporary;
  const NpzFrame frame;
  const ChannelSet set = frame.channels();
  write_npz_to(temporary.path() / "frame.npz", set);
  const std::map<std::string, std::string> files = unpacked(temporary.path() / "frame.npz");
  REQUIRE(files.size() == 2);
  CHECK(files.at("f1.distance_m.npy") == npy_of(set.channels[0]));
  CHECK(files.at("object_id.npy") == npy_of(set.channels[1]));
}

TEST_CASE("the same frame is the same archive, whenever and wherever it is written") {
  const pmdsim::test::TemporaryFolder temporary;
  const NpzFrame frame;
  write_npz_to(temporary.path() / "one.npz", frame.channels());
  ::setenv("TZ", "Asia/Tokyo", 1);
  ::tzset();
  write_npz_to(temporary.path() / "other.npz", frame.channels());
  ::unsetenv("TZ");
  ::tzset();
  CHECK(content_of(temporary.path() / "one.npz") == content_of(temporary.path() / "other.npz"));
}

TEST_CASE("a disk that is full before an archive's end is an error") {
  const pmdsim::test::TemporaryFolder temporary;
  const std::vector<float> values(700 * 600, 1.0f);
  const ChannelSet set{{700, 600}, {{"z_m", "m", std::span(values)}, {"range_m", "m", std::span(values)}}};
  const std::size_t whole = 2 * values.size() * sizeof(float);
  for (const std::size_t bytes : {std::size_t{10}, whole / 3, whole}) {
    const FileSizeLimit limit(bytes);
    CHECK_THROWS_WITH(write_npz_to(temporary.path() / "frame.npz", set),
                      (temporary.path() / "frame.npz").string() + ": cannot be written: File too large");
  }
  CHECK(std::filesystem::is_empty(temporary.path()));
}
