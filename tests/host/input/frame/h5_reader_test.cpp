// Frames in HDF5 files: all channels that there may be, and files that are damaged or of other things.

#include "host/hdf5/hdf5.h"
#include "host/output/files/channel.h"
#include "host/output/files/h5_writer.h"
#include "tests/host/input/frame/frame_bits.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <functional>
#include <hdf5_hl.h>
#include <malloc.h>
#include <string>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// HDF5 cannot close all that damaged files have opened, and would say so at the end of the process.
[[maybe_unused]] const herr_t stays_open = H5dont_atexit();

// A file of HDF5 that `fill` makes.
std::filesystem::path made_h5(const TemporaryFolder &folder, const std::function<void(hid_t)> &fill) {
  const std::filesystem::path path = folder.path() / "made.h5";
  const Hdf5Turn turn;
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  fill(file.id());
  return path;
}

} // namespace

TEST_CASE("every channel that a frame may have is read from HDF5, in the order in which it is written") {
  const TemporaryFolder folder;
  constexpr std::size_t frequencies = 16, taps = 16;
  const std::vector<float> floats(2, 1.5f);
  const std::vector<std::uint32_t> ids(2, 3u);
  Measurement all;
  all.resolution = {2, 1};
  all.returns.resize(frequencies);
  for (Return &of_frequency : all.returns)
    of_frequency.taps.resize(taps);
  for_each_channel(all, [&](const ChannelIndex &, auto &values) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(values)>, std::vector<float>>)
      values = floats;
    else
      values = ids;
  });
  ChannelSet written{all.resolution, {}};
  for (std::size_t f = 0; f < frequencies; ++f)
    written.channels.push_back({"deformation_mm", "mm", std::span(floats), f});
  for (const Channel &channel : channels_of(all).channels)
    written.channels.push_back(channel);
  OutputFile file(folder.path() / "all.h5");
  write_h5(file, written, {Sensor{}, 0, 0.0});
  file.close();
  file.publish();
  const ReadFrame read = read_frame(folder.path() / "all.h5");
  REQUIRE(read.channels.size() == written.channels.size());
  for (std::size_t i = 0; i < read.channels.size(); ++i) {
    CHECK(read.channels[i].name == written.channels[i].name());
    CHECK(read.channels[i].unit == written.channels[i].unit);
  }
}

TEST_CASE("compressed HDF5 datasets are read, and dimension scales are no channels") {
  const TemporaryFolder folder;
  const std::vector<float> values{1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f};
  const auto path = made_h5(folder, [&](hid_t file) {
    const hsize_t sizes[2]{2, 3}, line = 3;
    const Hdf5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(creation.id(), 2, sizes);
    H5Pset_shuffle(creation.id());
    H5Pset_deflate(creation.id(), 1);
    const Hdf5Handle dataset(
        H5Dcreate2(file, "z_m", H5T_IEEE_F32BE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(dataset.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5LTmake_dataset(file, "column", 1, &line, H5T_NATIVE_FLOAT, values.data());
  });
  const ReadFrame read = read_frame(path);
  REQUIRE(read.channels.size() == 1);
  CHECK(read.channels[0].unit == "m"); // by its name
  CHECK(std::get<std::vector<float>>(read.channels[0].values) == values);
}

TEST_CASE("of a HDF5 file that is cut short it is said that it is") {
  const TemporaryFolder folder;
  WrittenFrame({64, 64}).write(folder.path() / "whole.h5");
  const std::string whole = bytes_of(folder.path() / "whole.h5");
  check_refused(folder.write("short.h5", whole.substr(0, whole.size() / 2)), "truncated file");
}

TEST_CASE("HDF5 files of other things are refused") {
  const TemporaryFolder folder;
  const std::vector<int> values(6, 1);
  const hsize_t sizes[2]{2, 3}, others[2]{3, 2};
  check_refused(made_h5(folder, [](hid_t) {}), "expected channels as two-dimensional datasets");
  check_refused(
      made_h5(folder, [&](hid_t file) { H5LTmake_dataset_int(file, "z_m", 2, sizes, values.data()); }),
      "dataset z_m: expected float32, float64 or uint32");
  check_refused(made_h5(folder,
                        [&](hid_t file) {
                          const std::vector<float> floats(6);
                          H5LTmake_dataset_float(file, "range_m", 2, sizes, floats.data());
                          H5LTmake_dataset_float(file, "z_m", 2, others, floats.data());
                        }),
                "dataset z_m: expected 3 x 2 pixels as the others have");
  check_refused(made_h5(folder,
                        [&](hid_t file) { // of which nothing is there
                          const hsize_t huge[2]{1u << 30, 1u << 30}, chunk[2]{1, 1024};
                          const Hdf5Handle space(H5Screate_simple(2, huge, nullptr), H5Sclose);
                          const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
                          H5Pset_chunk(creation.id(), 2, chunk);
                          const Hdf5Handle dataset(H5Dcreate2(file, "z_m", H5T_IEEE_F32LE, space.id(),
                                                              H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                                                   H5Dclose);
                        }),
                "expected the values of 1073741824 x 1073741824 pixels");
  check_refused(made_h5(folder,
                        [&](hid_t file) { // in another file
                          const Hdf5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
                          const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
                          H5Pset_external(creation.id(), "/etc/passwd", 0, 24);
                          const Hdf5Handle dataset(H5Dcreate2(file, "z_m", H5T_IEEE_F32LE, space.id(),
                                                              H5P_DEFAULT, creation.id(), H5P_DEFAULT),
                                                   H5Dclose);
                        }),
                "dataset z_m: expected values in this file");
}

TEST_CASE("HDF5 files whose names cannot be listed are refused") {
  const TemporaryFolder folder;
  const std::vector<float> floats(2, 1.5f);
  ChannelSet many{{2, 1}, {}}; // more than fit into memory that is handed out again as it is
  for (const std::string quantity : {"amplitude", "distance_m", "phase_rad", "tap0", "tap1", "tap2"})
    for (std::size_t f = 0; f < 16; ++f)
      many.channels.push_back({quantity, "", std::span(floats), f});
  OutputFile file(folder.path() / "many.h5");
  write_h5(file, many, {Sensor{}, 0, 0.0});
  file.close();
  file.publish();
  std::string changed = bytes_of(folder.path() / "many.h5");
  // Version, flags, order and length come before the name of a link.
  const std::size_t version = changed.find("f15.tap1") - 11;
  REQUIRE(changed[version] == 1);
  changed[version] = '\x7f';
  folder.write("changed.h5", changed);
  mallopt(M_PERTURB, 165); // memory that nobody has set is not 0
  check_refused(folder.path() / "changed.h5", "cannot be read");
  mallopt(M_PERTURB, 0);
}

TEST_CASE("compressed chunks that are too short or too long are refused") {
  const TemporaryFolder folder;
  for (const std::size_t bytes : {0u, 8u, 20u, 24u, 28u, 4096u}) {
    const auto path = made_h5(folder, [&](hid_t file) {
      const hsize_t sizes[2]{2, 3}, at[2]{0, 0};
      const Hdf5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
      const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_chunk(creation.id(), 2, sizes);
      H5Pset_deflate(creation.id(), 1);
      const Hdf5Handle dataset(
          H5Dcreate2(file, "z_m", H5T_IEEE_F32LE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
          H5Dclose);
      std::vector<std::uint8_t> stored{0x78, 0x01, 0x01}; // zlib, one block as it is
      for (const std::size_t length : {bytes, ~bytes})
        for (const unsigned shift : {0u, 8u})
          stored.push_back(static_cast<std::uint8_t>(length >> shift));
      stored.insert(stored.end(), bytes, 0);
      const auto sum = static_cast<std::uint32_t>(bytes << 16 | 1); // Adler-32 of zeros
      for (const unsigned shift : {24u, 16u, 8u, 0u})
        stored.push_back(static_cast<std::uint8_t>(sum >> shift));
      H5Dwrite_chunk(dataset.id(), H5P_DEFAULT, 0, at, stored.size(), stored.data());
    });
    INFO(bytes << " bytes");
    if (bytes == 24)
      CHECK(std::get<std::vector<float>>(read_frame(path).channels.at(0).values) == std::vector<float>(6));
    else
      check_refused(path, "dataset z_m: expected whole chunks");
  }
}

TEST_CASE("compact values that are fewer than the pixels are refused") {
  const TemporaryFolder folder;
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  const auto path = made_h5(folder, [&](hid_t file) {
    const hsize_t sizes[2]{2, 3};
    const Hdf5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_layout(creation.id(), H5D_COMPACT);
    const Hdf5Handle dataset(
        H5Dcreate2(file, "z_m", H5T_IEEE_F32LE, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(dataset.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  });
  CHECK(std::get<std::vector<float>>(read_frame(path).channels.at(0).values) == values);

  std::string changed = bytes_of(path);
  const std::string stored(reinterpret_cast<const char *>(values.data()), values.size() * sizeof(float));
  const std::size_t size = changed.find(stored) - 2; // in front of the values, in two bytes
  REQUIRE(changed.at(size) == 24);
  changed[size] = 8;
  folder.write("changed.h5", changed);
  check_refused(folder.path() / "changed.h5", "dataset z_m: expected a value for each pixel");
}

TEST_CASE("chunks without compression are all there and of the channel's type") {
  const TemporaryFolder folder;
  const std::vector<float> values{1, 2, 3, 4, 5, 6};
  const auto made = [&](bool both, hid_t type) {
    return made_h5(folder, [&](hid_t file) {
      const hsize_t sizes[2]{2, 3}, row[2]{1, 3}, at[2]{both ? 0u : 1u, 0}, rows[2]{both ? 2u : 1u, 3};
      const Hdf5Handle space(H5Screate_simple(2, sizes, nullptr), H5Sclose),
          part(H5Screate_simple(2, rows, nullptr), H5Sclose);
      const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_chunk(creation.id(), 2, row);
      H5Pset_alloc_time(creation.id(), H5D_ALLOC_TIME_INCR);
      const Hdf5Handle dataset(
          H5Dcreate2(file, "z_m", type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Dclose);
      H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, at, nullptr, rows, nullptr);
      H5Dwrite(dataset.id(), H5T_NATIVE_FLOAT, part.id(), space.id(), H5P_DEFAULT, values.data());
    });
  };
  CHECK(std::get<std::vector<float>>(read_frame(made(true, H5T_IEEE_F32LE)).channels.at(0).values) == values);
  check_refused(made(false, H5T_IEEE_F32LE), "dataset z_m: expected whole chunks");
  check_refused(made(true, H5T_STD_I16LE), "dataset z_m: expected float32, float64 or uint32");
}

TEST_CASE("links to one dataset hold no more than the file, links elsewhere are no channels") {
  const TemporaryFolder folder;
  const auto make = [&](bool is_linked_often) {
    return made_h5(folder, [&](hid_t file) {
      const hsize_t sizes[2]{256, 256}; // most of the file's bytes
      const std::vector<float> values(256 * 256, 1.0f);
      H5LTmake_dataset_float(file, "z_m", 2, sizes, values.data());
      H5Lcreate_soft("/z_m", file, "range_m", H5P_DEFAULT, H5P_DEFAULT);
      H5Lcreate_external("other.h5", "/z_m", file, "coverage", H5P_DEFAULT, H5P_DEFAULT);
      if (is_linked_often)
        H5Lcreate_hard(file, "z_m", file, "lit", H5P_DEFAULT, H5P_DEFAULT);
    });
  };
  const ReadFrame read = read_frame(make(false));
  REQUIRE(read.channels.size() == 1);
  CHECK(read.channels[0].name == "z_m");
  check_refused(make(true), "dataset lit: expected datasets of");
}

TEST_CASE("a lack of bytes in a file is no lack of memory, though HDF5 calls it one") {
  const auto lacks_memory = [](const char *text) {
    const Hdf5Turn turn;
    H5Epush2(H5E_DEFAULT, __FILE__, "decode", __LINE__, H5E_ERR_CLS, H5E_RESOURCE, H5E_NOSPACE, "%s", text);
    return hdf5_reason().lacks_memory;
  };
  CHECK(lacks_memory("memory allocation failed"));
  CHECK_FALSE(lacks_memory("ran off the end of the buffer: current p = 0x1, p_size = 56, p_end = 0x0"));
}
