#include "host/output/files/channel.h"

#include "engine/model/channel_names.h"
#include "host/output/files/output_file.h"
#include "host/output/files/zip_block.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <openexr.h>
#include <string_view>
#include <type_traits>
#include <utility>

namespace pmdsim {
namespace {

constexpr int only_part = 0;
constexpr std::size_t value_bytes = 4;

exr_pixel_type_t pixel_type(std::span<const float>) { return EXR_PIXEL_FLOAT; }
exr_pixel_type_t pixel_type(std::span<const std::uint32_t>) { return EXR_PIXEL_UINT; }

// Pieces one behind the other become writes of many whole pages, which go past the page cache.
class GatheredWrites {
public:
  explicit GatheredWrites(OutputFile &file) : file_(file) { gathered_.reserve(2 * many_bytes); }

  void write(std::uint64_t offset, std::string_view bytes) {
    if (offset != start_ + gathered_.size()) {
      write_first(gathered_.size());
      file_.seek(start_ = offset);
    }
    gathered_ += bytes;
    if (gathered_.size() >= many_bytes)
      write_first(gathered_.size() - (start_ + gathered_.size()) % page_bytes);
  }
  void finish() { write_first(gathered_.size()); }

private:
  static constexpr std::size_t page_bytes = 4096, many_bytes = std::size_t{1} << 20;

  void write_first(std::size_t bytes) {
    file_.write(std::string_view(gathered_).substr(0, bytes));
    gathered_.erase(0, bytes);
    start_ += bytes;
  }

  OutputFile &file_;
  std::string gathered_;
  std::uint64_t start_ = 0; // where in the file they begin
};

// A file of blocks of rows that are packed already.
class ExrFile {
public:
  ExrFile(OutputFile &file, const ChannelSet &channels) : path_(file.path().string()), writes_(file) {
    exr_context_initializer_t with = EXR_DEFAULT_CONTEXT_INITIALIZER;
    with.user_data = this;
    with.write_fn = write;
    with.error_handler_fn = [](exr_const_context_t, exr_result_t, const char *) {}; // check() tells
    exr_context_t context = nullptr;
    check(exr_start_write(&context, path_.c_str(), EXR_WRITE_FILE_DIRECTLY, &with));
    context_.reset(context);
    write_header(channels);
  }
  ExrFile(const ExrFile &) = delete; // OpenEXR knows where it is
  ExrFile &operator=(const ExrFile &) = delete;

  void write_block(std::size_t first_row, std::span<const unsigned char> packed) {
    check(exr_write_scanline_chunk(context_.get(), only_part, static_cast<int>(first_row), packed.data(),
                                   packed.size()));
  }
  // After the last block.
  void finish() { writes_.finish(); }

private:
  using Context = std::unique_ptr<std::remove_pointer_t<exr_context_t>,
                                  decltype([](exr_context_t context) { exr_finish(&context); })>;

  void write_header(const ChannelSet &channels) {
    auto *const context = context_.get();
    int part = only_part;
    check(exr_add_part(context, nullptr, EXR_STORAGE_SCANLINE, &part));
    check(exr_initialize_required_attr_simple(context, part, static_cast<int>(channels.resolution.x),
                                              static_cast<int>(channels.resolution.y), EXR_COMPRESSION_ZIP));
    for (const Channel &channel : channels.channels) {
      const auto type = std::visit([](auto values) { return pixel_type(values); }, channel.values);
      check(exr_add_channel(context, part, channel.name().c_str(), type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    }
    check(exr_write_header(context));
  }

  // No exception may pass through OpenEXR's C.
  static std::int64_t write(exr_const_context_t, void *user_data, const void *bytes, std::uint64_t count,
                            std::uint64_t offset, exr_stream_error_func_ptr_t) {
    auto &file = *static_cast<ExrFile *>(user_data);
    try {
      file.writes_.write(offset, {static_cast<const char *>(bytes), count});
      return static_cast<std::int64_t>(count);
    } catch (...) {
      file.failure_ = std::current_exception();
      return -1;
    }
  }

  void check(exr_result_t result) const {
    if (failure_)
      std::rethrow_exception(failure_);
    if (result != EXR_ERR_SUCCESS)
      throw write_error(path_, exr_get_default_error_message(result),
                        result == EXR_ERR_OUT_OF_MEMORY ? Lacking::memory : Lacking::other);
  }

  std::string path_;
  GatheredWrites writes_;
  std::exception_ptr failure_;
  Context context_;
};

ScanLines scan_lines(const ChannelSet &channels) {
  std::vector<std::pair<std::string, const unsigned char *>> by_name;
  for (const Channel &channel : channels.channels)
    std::visit(
        [&](auto values) {
          static_assert(sizeof(values[0]) == value_bytes);
          by_name.emplace_back(channel.name(), reinterpret_cast<const unsigned char *>(values.data()));
        },
        channel.values);
  std::ranges::sort(by_name);
  ScanLines lines{{}, value_bytes * channels.resolution.x, channels.resolution.y};
  for (const auto &[name, first_row] : by_name)
    lines.channels.push_back(first_row);
  return lines;
}

// What rounding took from the channels that are unrounded, too, as channels beside them.
class Rests {
public:
  explicit Rests(const ChannelSet &channels) : with_(channels) {
    for (const Channel &channel : channels.channels)
      if (!channel.unrounded.empty())
        add(channel);
  }
  Rests(const Rests &) = delete; // channels look at its values
  Rests &operator=(const Rests &) = delete;

  const ChannelSet &with() const { return with_; }

private:
  void add(const Channel &channel) {
    const auto rounded = std::get<std::span<const float>>(channel.values);
    std::vector<float> &rests = rests_.emplace_back();
    rests.reserve(rounded.size());
    for (std::size_t i = 0; i < rounded.size(); ++i)
      rests.push_back(static_cast<float>(channel.unrounded[i] - static_cast<double>(rounded[i])));
    with_.channels.push_back(
        {rest_name(channel.quantity), channel.unit, std::span<const float>(rests), channel.frequency});
  }

  ChannelSet with_;
  std::deque<std::vector<float>> rests_;
};

} // namespace

void write_exr(OutputFile &file, const ChannelSet &set) {
  const Rests rests(set);
  const ChannelSet &channels = rests.with();
  ExrFile exr(file, channels);
  const ScanLines lines = scan_lines(channels);
  ZipBlock block(lines);
  for (std::size_t row = 0; row < lines.rows; row += ZipBlock::most_rows)
    exr.write_block(row, block.pack(row));
  exr.finish();
}

} // namespace pmdsim
