#include "engine/model/channel_names.h"
#include "host/input/frame/frame_bytes.h"
#include "host/input/words/utf8.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <openexr.h>
#include <optional>
#include <set>
#include <span>
#include <type_traits>

namespace pmdsim {
namespace {

constexpr int only_part = 0;
constexpr std::uint64_t chunk_entry_bytes = 8; // of each chunk, in the file's table

class ExrReader {
public:
  explicit ExrReader(const FrameBytes &frame) : frame_(frame) {
    exr_context_initializer_t with = EXR_DEFAULT_CONTEXT_INITIALIZER;
    with.user_data = const_cast<FrameBytes *>(&frame); // which is only read
    with.read_fn = read;
    with.size_fn = [](exr_const_context_t, void *of) {
      return static_cast<std::int64_t>(static_cast<const FrameBytes *>(of)->content.size());
    };
    with.error_handler_fn = [](exr_const_context_t, exr_result_t, const char *) {}; // check() tells
    exr_context_t context = nullptr;
    check(exr_start_read(&context, frame.file.c_str(), &with));
    context_.reset(context);
  }

  ReadFrame frame() {
    ReadFrame read = header();
    rows_of_chunk_ = rows_of_chunk(read.resolution.y);
    Decoder decoder(context_.get());
    for (std::uint32_t row = 0; row < read.resolution.y; row += rows_of_chunk_)
      decode(decoder, row, read);
    return read;
  }

private:
  using Context = std::unique_ptr<std::remove_pointer_t<exr_context_t>,
                                  decltype([](exr_context_t context) { exr_finish(&context); })>;

  struct Decoder {
    explicit Decoder(exr_const_context_t of) : context(of) {}
    Decoder(const Decoder &) = delete;
    Decoder &operator=(const Decoder &) = delete;
    ~Decoder() { exr_decoding_destroy(context, &pipeline); }

    exr_const_context_t context;
    exr_decode_pipeline_t pipeline{};
    bool is_ready = false;
  };

  static std::int64_t read(exr_const_context_t, void *of, void *to, std::uint64_t count, std::uint64_t offset,
                           exr_stream_error_func_ptr_t) {
    const std::string &content = static_cast<const FrameBytes *>(of)->content;
    if (offset > content.size())
      return -1;
    const std::uint64_t there = std::min<std::uint64_t>(count, content.size() - offset);
    std::memcpy(to, content.data() + offset, there);
    return static_cast<std::int64_t>(there);
  }

  void check(exr_result_t result) const {
    if (result != EXR_ERR_SUCCESS)
      throw frame_error(frame_,
                        fmt::format("cannot be read as EXR: {}", exr_get_default_error_message(result)));
  }

  void require(bool is_so, std::string_view what) const {
    if (!is_so)
      throw frame_error(frame_, fmt::format("expected {}", what));
  }

  // The channels without values, but with room for them.
  ReadFrame header() {
    int parts = 0;
    exr_storage_t storage{};
    exr_compression_t compression{};
    exr_attr_box2i_t window{};
    const exr_attr_chlist_t *channels = nullptr;
    check(exr_get_count(context_.get(), &parts));
    require(parts == 1, "one part in the EXR file");
    check(exr_get_storage(context_.get(), only_part, &storage));
    require(storage == EXR_STORAGE_SCANLINE, "scan lines in the EXR file");
    check(exr_get_compression(context_.get(), only_part, &compression));
    require(compression <= EXR_COMPRESSION_ZIP, "no compression or RLE, ZIPS or ZIP in the EXR file");
    check(exr_get_data_window(context_.get(), only_part, &window));
    check(exr_get_channels(context_.get(), only_part, &channels));
    constexpr int most_channels = 4096;
    require(channels && channels->num_channels > 0 && channels->num_channels <= most_channels,
            "1 to 4096 channels in the EXR file");
    first_row_ = window.min.y;
    ReadFrame read{checked_resolution(
        frame_, size(window.min.x, window.max.x), size(window.min.y, window.max.y),
        sizeof(float) * static_cast<std::uint64_t>(channels->num_channels), frame_.content.size())};
    constexpr std::uint32_t max_columns =
        std::numeric_limits<std::int32_t>::max() / sizeof(float); // by OpenEXR's strides
    require(read.resolution.x <= max_columns, "at most 536870911 columns in the EXR file");
    const std::span entries(channels->entries, static_cast<std::size_t>(channels->num_channels));
    for (const exr_attr_chlist_entry_t &entry : entries)
      read.channels.push_back(channel(entry, std::size_t{read.resolution.x} * read.resolution.y));
    return read;
  }

  static std::uint64_t size(std::int64_t first, std::int64_t last) {
    return last < first ? 0 : static_cast<std::uint64_t>(last - first + 1);
  }

  ReadChannel channel(const exr_attr_chlist_entry_t &entry, std::size_t values) const {
    const std::string name(entry.name.str, static_cast<std::size_t>(entry.name.length));
    require(is_utf8(name), "names of channels in UTF-8 in the EXR file");
    require(entry.x_sampling == 1 && entry.y_sampling == 1, "every channel of an EXR file at every pixel");
    require(entry.pixel_type == EXR_PIXEL_FLOAT || entry.pixel_type == EXR_PIXEL_UINT,
            "channels of FLOAT and UINT in the EXR file");
    if (entry.pixel_type == EXR_PIXEL_FLOAT)
      return {name, unit_of(name), std::vector<float>(values)};
    return {name, unit_of(name), std::vector<std::uint32_t>(values)};
  }

  std::uint32_t rows_of_chunk(std::uint32_t rows) const {
    std::int32_t of_chunk = 0;
    check(exr_get_scanlines_per_chunk(context_.get(), only_part, &of_chunk));
    require(of_chunk > 0, "chunks of scan lines in the EXR file");
    const auto rows_of = static_cast<std::uint32_t>(of_chunk);
    const std::uint64_t chunks = (std::uint64_t{rows} + rows_of - 1) / rows_of;
    require(chunks * chunk_entry_bytes <= frame_.content.size(), "all scan lines in the EXR file");
    return rows_of;
  }

  void decode(Decoder &decoder, std::uint32_t row, ReadFrame &to) {
    exr_chunk_info_t chunk{};
    const int in_window = static_cast<int>(first_row_ + std::int64_t{row});
    check(exr_read_scanline_chunk_info(context_.get(), only_part, in_window, &chunk));
    exr_decode_pipeline_t &pipeline = decoder.pipeline;
    if (decoder.is_ready)
      check(exr_decoding_update(context_.get(), only_part, &chunk, &pipeline));
    else
      check(exr_decoding_initialize(context_.get(), only_part, &chunk, &pipeline));
    const std::uint32_t rows = std::min(rows_of_chunk_, to.resolution.y - row);
    require(pipeline.channel_count == static_cast<std::int64_t>(to.channels.size()) &&
                chunk.height == static_cast<std::int64_t>(rows) &&
                chunk.width == static_cast<std::int64_t>(to.resolution.x),
            "chunks of the frame's size in the EXR file");
    for (std::size_t i = 0; i < to.channels.size(); ++i)
      set_destination(pipeline.channels[i], to.channels[i], std::size_t{row} * to.resolution.x,
                      to.resolution.x);
    if (!decoder.is_ready)
      check(exr_decoding_choose_default_routines(context_.get(), only_part, &pipeline));
    decoder.is_ready = true;
    check(exr_decoding_run(context_.get(), only_part, &pipeline));
  }

  static void set_destination(exr_coding_channel_info_t &from, ReadChannel &to, std::size_t first,
                              std::uint32_t columns) {
    std::visit(
        [&](auto &values) {
          from.decode_to_ptr = reinterpret_cast<std::uint8_t *>(values.data() + first);
          from.user_pixel_stride = sizeof(values[0]);
          from.user_line_stride = static_cast<std::int32_t>(sizeof(values[0]) * columns);
          from.user_bytes_per_element = sizeof(values[0]);
          from.user_data_type = from.data_type;
        },
        to.values);
  }

  const FrameBytes &frame_;
  Context context_;
  std::int64_t first_row_ = 0;
  std::uint32_t rows_of_chunk_ = 1;
};

} // namespace

namespace {

ReadChannel *floats_named(ReadFrame &frame, const std::string &name) {
  const auto found = std::ranges::find(frame.channels, name, &ReadChannel::name);
  const bool are_floats =
      found != frame.channels.end() && std::holds_alternative<std::vector<float>>(found->values);
  return are_floats ? &*found : nullptr;
}

std::vector<double> sums(const std::vector<float> &rounded, const std::vector<float> &rests) {
  std::vector<double> whole(rounded.size());
  std::ranges::transform(rounded, rests, whole.begin(), [](float value, float rest) {
    return static_cast<double>(value) + static_cast<double>(rest);
  });
  return whole;
}

// Puts together what the file has as a channel and its rest.
void join_rests(ReadFrame &frame) {
  std::set<std::string> joined;
  for (const ReadChannel &channel : frame.channels) {
    const std::optional<std::string> name = name_of_rest(channel.name);
    const auto *rests = std::get_if<std::vector<float>>(&channel.values);
    ReadChannel *const rounded = name && rests ? floats_named(frame, *name) : nullptr;
    if (!rounded)
      continue;
    rounded->values = sums(std::get<std::vector<float>>(rounded->values), *rests);
    joined.insert(channel.name);
  }
  std::erase_if(frame.channels, [&](const ReadChannel &channel) { return joined.contains(channel.name); });
}

} // namespace

ReadFrame read_exr(const FrameBytes &frame) {
  ReadFrame read = ExrReader(frame).frame();
  join_rests(read);
  return read;
}

} // namespace pmdsim
