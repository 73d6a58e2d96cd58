#include "host/output/files/channel.h"

#include "engine/model/error.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <mutex>
#include <thread>

namespace pmdsim {
namespace {

class StreamOntoOutputFile : public Imf::OStream {
public:
  explicit StreamOntoOutputFile(OutputFile &file) : Imf::OStream(file.path().c_str()), file_(file) {}
  void write(const char bytes[], int count) override {
    file_.write({bytes, static_cast<std::size_t>(count)});
  }
  std::uint64_t tellp() override { return file_.tell(); }
  void seekp(std::uint64_t offset) override { file_.seek(offset); }

private:
  OutputFile &file_;
};

Imf::PixelType pixel_type(std::span<const float>) { return Imf::FLOAT; }
Imf::PixelType pixel_type(std::span<const std::uint32_t>) { return Imf::UINT; }

// Compression takes longest, and OpenEXR's own threads share out the lines of one file: all of them work on
// the file that is begun first, so that no more frames than two need be held at once. Its lines come in
// order, whatever the threads.
void start_compressing_threads() {
  static std::once_flag started;
  std::call_once(started, Imf::setGlobalThreadCount, static_cast<int>(std::thread::hardware_concurrency()));
}

// OpenEXR's slices are writable for its reader's sake; its writer only reads them.
template <typename T>
char *base_address(std::span<const T> values) {
  return const_cast<char *>(reinterpret_cast<const char *>(values.data()));
}

} // namespace

void write_exr(OutputFile &file, const ChannelSet &channels) {
  const auto [columns, rows] =
      std::pair(static_cast<int>(channels.resolution.x), static_cast<int>(channels.resolution.y));
  Imf::Header header(columns, rows, 1.0f, Imath::V2f(0.0f, 0.0f), 1.0f, Imf::INCREASING_Y,
                     Imf::ZIP_COMPRESSION);
  Imf::FrameBuffer frame;
  for (const Channel &channel : channels.channels)
    std::visit(
        [&](auto values) {
          constexpr std::size_t value_bytes = sizeof(values[0]);
          header.channels().insert(channel.name(), Imf::Channel(pixel_type(values)));
          frame.insert(channel.name(), Imf::Slice(pixel_type(values), base_address(values), value_bytes,
                                                  value_bytes * channels.resolution.x));
        },
        channel.values);
  start_compressing_threads();
  try {
    StreamOntoOutputFile stream(file);
    Imf::OutputFile exr(stream, header);
    exr.setFrameBuffer(frame);
    exr.writePixels(rows);
  } catch (const Iex::BaseExc &error) {
    throw Error(ExitCode::output,
                fmt::format("{}: cannot be written: {}", file.path().string(), error.what()));
  }
}

} // namespace pmdsim
