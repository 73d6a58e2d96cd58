#include "engine/model/error.h"
#include "engine/model/scene.h"
#include "host/hdf5/hdf5.h"
#include "host/output/files/h5_writer.h"
#include "host/output/files/manifest.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/file_size_limit.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <hdf5_hl.h>
#include <limits>
#include <string>
#include <thread>
#include <vector>

using namespace pmdsim;

namespace {

Sensor h5_sensor() {
  Sensor sensor;
  sensor.name = "pmd";
  sensor.resolution = {5, 3};
  sensor.modulation_hz = {16e6, 80e6};
  return sensor;
}

const std::vector<float> h5_distances(15, 2.5f);
const std::vector<std::uint32_t> h5_ids(15, no_id);

ChannelSet h5_channels() {
  return {{5, 3},
          {{"phase_rad", "rad", std::span(h5_distances), 0, std::nullopt, "what it is"},
           {"object_id", "", std::span(h5_ids)},
           {"amplitude", "W/(m² sr)", std::span(h5_distances), 0}}};
}

void write_h5_to(const std::filesystem::path &path, const ChannelSet &channels, const Sensor &sensor) {
  OutputFile file(path);
  write_h5(file, channels, {sensor, 4, 0.5});
  file.close();
  file.publish();
}

// What a file says, by HDF5's own simple calls.
class H5Content {
public:
  explicit H5Content(const std::filesystem::path &path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    REQUIRE(file_.id() >= 0);
  }

  std::string text(const std::string &of, const std::string &name) const {
    hsize_t size = 0;
    std::size_t bytes = 0;
    H5T_class_t kind{};
    REQUIRE(H5LTget_attribute_info(file_.id(), of.c_str(), name.c_str(), &size, &kind, &bytes) >= 0);
    CHECK(kind == H5T_STRING);
    std::string value(bytes, '\0');
    REQUIRE(H5LTget_attribute_string(file_.id(), of.c_str(), name.c_str(), value.data()) >= 0);
    return value.c_str();
  }
  std::vector<double> numbers(const std::string &of, const std::string &name, std::size_t count) const {
    std::vector<double> values(count);
    REQUIRE(H5LTget_attribute_double(file_.id(), of.c_str(), name.c_str(), values.data()) >= 0);
    return values;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    const auto keep = [](hid_t, const char *name, const H5L_info_t *, void *to) -> herr_t {
      static_cast<std::vector<std::string> *>(to)->emplace_back(name);
      return 0;
    };
    REQUIRE(H5Literate(file_.id(), H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, keep, &names) >= 0);
    return names;
  }
  std::string scale(const std::string &of, unsigned dimension) const {
    const Hdf5Handle dataset(H5Dopen2(file_.id(), of.c_str(), H5P_DEFAULT), H5Dclose);
    std::string name(100, '\0');
    const auto look = [](hid_t, unsigned, hid_t scale, void *to) -> herr_t {
      auto &text = *static_cast<std::string *>(to);
      text.resize(static_cast<std::size_t>(H5DSget_scale_name(scale, text.data(), text.size())));
      return 1;
    };
    REQUIRE(H5DSiterate_scales(dataset.id(), dimension, nullptr, look, &name) == 1);
    return name;
  }
  std::vector<std::uint32_t> indices(const std::string &of, std::size_t count) const {
    std::vector<std::uint32_t> values(count);
    REQUIRE(H5LTread_dataset(file_.id(), of.c_str(), H5T_NATIVE_UINT32, values.data()) >= 0);
    return values;
  }

private:
  Hdf5Handle file_;
};

} // namespace

TEST_CASE("an HDF5 file tells what its datasets are, along which axes, and of which frame") {
  const pmdsim::test::TemporaryFolder temporary;
  const Sensor sensor = h5_sensor();
  write_h5_to(temporary.path() / "frame.h5", h5_channels(), sensor);
  const Hdf5Turn turn;
  const H5Content h5(temporary.path() / "frame.h5");
  CHECK(h5.names() == std::vector<std::string>{"row", "column", "f0.phase_rad", "object_id", "f0.amplitude"});
  CHECK(h5.text("f0.phase_rad", "units") == "rad");
  CHECK(h5.text("f0.phase_rad", "long_name") == "what it is");
  CHECK(std::isnan(h5.numbers("f0.phase_rad", "_FillValue", 1)[0]));
  CHECK(h5.text("f0.amplitude", "units") == "W/(m² sr)");
  CHECK(h5.text("object_id", "units").empty());
  for (const std::string name : {"f0.phase_rad", "object_id", "f0.amplitude"}) {
    CHECK(h5.scale(name, 0) == "row");
    CHECK(h5.scale(name, 1) == "column");
  }
  CHECK(h5.indices("row", 3) == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(h5.indices("column", 5) == std::vector<std::uint32_t>{0, 1, 2, 3, 4});
  CHECK(h5.text("/", "program") == "pmdsim");
  CHECK(h5.text("/", "sensor") == "pmd");
  CHECK(h5.numbers("/", "frame", 1)[0] == 4.0);
  CHECK(h5.numbers("/", "time_s", 1)[0] == 0.5);
  CHECK(h5.numbers("/", "modulation_hz", 2) == sensor.modulation_hz);
  CHECK(h5.numbers("/", "ambiguity_m", 2) == ambiguities_m(sensor));
  CHECK(h5.text("/", "camera") == camera_json(sensor).dump());
}

TEST_CASE("the same frame is the same HDF5 file, on whichever thread it is written") {
  const pmdsim::test::TemporaryFolder temporary;
  const auto path_of = [&](int i) { return temporary.path() / std::to_string(i); };
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] { write_h5_to(path_of(i), h5_channels(), h5_sensor()); });
  for (std::thread &thread : threads)
    thread.join();
  for (int i = 1; i < 4; ++i)
    CHECK(content_of(path_of(i)) == content_of(path_of(0)));
}

TEST_CASE("a disk that is full before an HDF5 file's end is an error, and nothing stays") {
  const pmdsim::test::TemporaryFolder temporary;
  const std::vector<float> values(700 * 600, 1.0f);
  const ChannelSet set{{700, 600}, {{"z_m", "m", std::span(values)}}};
  for (const std::size_t bytes : {std::size_t{10}, values.size() * sizeof(float)}) {
    const FileSizeLimit limit(bytes);
    CHECK_THROWS_WITH(write_h5_to(temporary.path() / "frame.h5", set, h5_sensor()),
                      (temporary.path() / "frame.h5").string() + ": cannot be written: File too large");
  }
  CHECK(std::filesystem::is_empty(temporary.path()));
}
