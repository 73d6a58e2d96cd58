#include "engine/model/scene.h"
#include "host/output/files/channel.h"
#include "tests/host/output/directory_content.h"
#include "tests/support/temporary_folder.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>

using namespace pmdsim;

namespace {

constexpr glm::uvec2 exr_resolution{5, 37}; // more than two of ZIP's blocks of 16 lines
constexpr std::size_t pixel_count = exr_resolution.x * exr_resolution.y;

Measurement numbered_measurement() {
  Measurement measurement;
  measurement.resolution = exr_resolution;
  measurement.returns.resize(1);
  float next = 0.1f;
  for (auto *channel : {&measurement.returns[0].amplitude, &measurement.returns[0].phase_rad,
                        &measurement.returns[0].distance_m, &measurement.range_m, &measurement.z_m,
                        &measurement.coverage, &measurement.lit})
    for (std::size_t pixel = 0; pixel < pixel_count; ++pixel)
      channel->push_back(next += 0.7f);
  for (std::uint32_t pixel = 0; pixel < pixel_count; ++pixel) {
    measurement.triangle_id.push_back(70000u + pixel);
    measurement.object_id.push_back(no_id);
  }
  measurement.returns[0].distance_m[7] = std::numeric_limits<float>::quiet_NaN();
  return measurement;
}

template <typename T>
std::vector<T> read_channel(Imf::InputFile &exr, const std::string &name, Imf::PixelType type) {
  std::vector<T> values(pixel_count);
  Imf::FrameBuffer frame;
  frame.insert(name, Imf::Slice(type, reinterpret_cast<char *>(values.data()), sizeof(T),
                                sizeof(T) * exr_resolution.x));
  exr.setFrameBuffer(frame);
  exr.readPixels(0, exr_resolution.y - 1);
  return values;
}

} // namespace

TEST_CASE("an EXR file gives back every bit under the channels' names") {
  const pmdsim::test::TemporaryFolder temporary;
  const Measurement measurement = numbered_measurement();
  OutputFile file(temporary.path() / "frame.exr");
  write_exr(file, channels_of(measurement));
  file.close();
  file.publish();

  Imf::InputFile exr(file.path().c_str());
  std::map<std::string, Imf::PixelType> found;
  for (auto channel = exr.header().channels().begin(); channel != exr.header().channels().end(); ++channel)
    found[channel.name()] = channel.channel().type;
  CHECK(found == std::map<std::string, Imf::PixelType>{{"amplitude", Imf::FLOAT},
                                                       {"phase_rad", Imf::FLOAT},
                                                       {"distance_m", Imf::FLOAT},
                                                       {"range_m", Imf::FLOAT},
                                                       {"z_m", Imf::FLOAT},
                                                       {"coverage", Imf::FLOAT},
                                                       {"lit", Imf::FLOAT},
                                                       {"triangle_id", Imf::UINT},
                                                       {"object_id", Imf::UINT}});
  CHECK(read_channel<float>(exr, "amplitude", Imf::FLOAT) == measurement.returns[0].amplitude);
  CHECK(read_channel<float>(exr, "phase_rad", Imf::FLOAT) == measurement.returns[0].phase_rad);
  CHECK(read_channel<float>(exr, "range_m", Imf::FLOAT) == measurement.range_m);
  CHECK(read_channel<float>(exr, "z_m", Imf::FLOAT) == measurement.z_m);
  CHECK(read_channel<float>(exr, "coverage", Imf::FLOAT) == measurement.coverage);
  CHECK(read_channel<float>(exr, "lit", Imf::FLOAT) == measurement.lit);
  CHECK(read_channel<std::uint32_t>(exr, "triangle_id", Imf::UINT) == measurement.triangle_id);
  CHECK(read_channel<std::uint32_t>(exr, "object_id", Imf::UINT) == measurement.object_id);
  const std::vector<float> distance_m = read_channel<float>(exr, "distance_m", Imf::FLOAT);
  CHECK(std::isnan(distance_m[7]));
  CHECK(distance_m[8] == measurement.returns[0].distance_m[8]);
}
