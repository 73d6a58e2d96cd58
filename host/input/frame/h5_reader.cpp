#include "host/input/frame/frame_bytes.h"

#include "engine/correction/corrected_channels.h"
#include "engine/model/channels.h"
#include "host/hdf5/memory_file.h"
#include "host/input/file/memory_request.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <libdeflate.h>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {
namespace {

// As setups have them at most: frequencies of a sensor, and taps of each.
constexpr std::size_t max_frequencies = 16, max_taps = 16;

// Before the names of channels: nothing, or the frequency that they belong to.
std::vector<std::string> prefixes() {
  std::vector<std::string> prefixes{""};
  for (std::size_t f = 0; f < max_frequencies; ++f)
    prefixes.push_back(fmt::format("f{}.", f));
  return prefixes;
}

// Of all channels that a file may have, in the order in which the program writes them.
std::vector<std::string> names_of_channels() {
  std::vector<std::string> names;
  for (const std::string &prefix : prefixes())
    names.push_back(fmt::format("{}{}", prefix, deformation_name));
  for (const std::string &prefix : prefixes())
    for (const ChannelRow &row : channel_rows)
      if (is_of_frequency(row) && !is_of_taps(row))
        names.push_back(fmt::format("{}{}", prefix, row.name));
  for (const std::string &prefix : prefixes())
    for (const ChannelRow &row : channel_rows)
      for (std::size_t k = 0; is_of_taps(row) && k < max_taps; ++k)
        names.push_back(fmt::format("{}{}{}", prefix, row.name, k));
  for (const ChannelRow &row : channel_rows)
    if (!is_of_frequency(row))
      names.emplace_back(row.name);
  for (const CorrectedChannelRow &row : corrected_channel_rows)
    if (std::ranges::find(names, row.name) == names.end())
      names.emplace_back(row.name);
  return names;
}

class H5Reader {
public:
  explicit H5Reader(const FrameBytes &frame) : frame_(frame), file_(frame.content) {
    check(file_.id() < 0 ? -1 : 0);
  }

  ReadFrame frame() {
    ReadFrame read;
    for (const std::string &name : names_of_channels()) {
      if (!is_there(name))
        continue;
      const Hdf5Handle object = opened(H5Oopen(file_.id(), name.c_str(), H5P_DEFAULT), H5Oclose);
      if (H5Iget_type(object.id()) != H5I_DATASET)
        continue;
      const Hdf5Handle creation = opened(H5Dget_create_plist(object.id()), H5Pclose);
      require_readable(creation.id(), name);
      const auto sizes = sizes_of(object.id());
      if (!sizes)
        continue;
      const auto [rows, columns] = *sizes;
      const hid_t type = type_in_memory(object.id(), name);
      const std::size_t value_bytes = H5Tget_size(type);
      const glm::uvec2 resolution =
          checked_resolution(frame_, columns, rows, value_bytes, stored_bytes(object.id(), name));
      if (!read.channels.empty() && resolution != read.resolution)
        throw frame_error(frame_, fmt::format("dataset {}: expected {} x {} pixels as the others have", name,
                                              read.resolution.x, read.resolution.y));
      if (!has_all_of_compact(object.id(), creation.id(), *sizes, value_bytes))
        throw frame_error(frame_, fmt::format("dataset {}: expected a value for each pixel", name));
      if (!has_whole_chunks(object.id(), creation.id(), *sizes, value_bytes))
        throw frame_error(frame_, fmt::format("dataset {}: expected whole chunks", name));
      read.resolution = resolution;
      read.channels.push_back(channel(object.id(), name, type, std::size_t{resolution.x} * resolution.y));
    }
    if (read.channels.empty())
      throw frame_error(frame_, "expected channels as two-dimensional datasets in the root group");
    return read;
  }

private:
  Hdf5Handle opened(hid_t id, herr_t (*closed_by)(hid_t)) const {
    check(id < 0 ? -1 : 0);
    return {id, closed_by};
  }

  void check(herr_t result) const {
    if (result >= 0)
      return;
    const Hdf5Reason reason = hdf5_reason();
    const Error error = frame_error(
        frame_, fmt::format("{}: {}", reason.lacks_memory ? "out of memory" : "cannot be read", reason.text));
    throw Error(reason.lacks_memory ? ExitCode::out_of_memory : ExitCode::input, error.what(), error.where());
  }

  // In this file itself. One name is looked up at a time: where HDF5 1.10 lists the names of a damaged
  // group, it frees what it never set.
  bool is_there(const std::string &name) const {
    const htri_t exists = H5Lexists(file_.id(), name.c_str(), H5P_DEFAULT);
    check(exists);
    if (exists == 0)
      return false;
    H5L_info_t link{};
    check(H5Lget_info(file_.id(), name.c_str(), &link, H5P_DEFAULT));
    return link.type == H5L_TYPE_HARD;
  }

  // Rows and columns; nothing where there are others.
  std::optional<std::array<hsize_t, 2>> sizes_of(hid_t dataset) const {
    const Hdf5Handle space = opened(H5Dget_space(dataset), H5Sclose);
    if (H5Sget_simple_extent_ndims(space.id()) != 2)
      return std::nullopt;
    std::array<hsize_t, 2> sizes{};
    check(H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr));
    return sizes;
  }

  // That of HDF5's types to which the values are converted.
  hid_t type_in_memory(hid_t dataset, const std::string &name) const {
    const Hdf5Handle type = opened(H5Dget_type(dataset), H5Tclose);
    const auto is_any = [&](hid_t one, hid_t other) {
      return H5Tequal(type.id(), one) > 0 || H5Tequal(type.id(), other) > 0;
    };
    if (is_any(H5T_IEEE_F32LE, H5T_IEEE_F32BE))
      return H5T_NATIVE_FLOAT;
    if (is_any(H5T_IEEE_F64LE, H5T_IEEE_F64BE))
      return H5T_NATIVE_DOUBLE;
    if (is_any(H5T_STD_U32LE, H5T_STD_U32BE))
      return H5T_NATIVE_UINT32;
    throw frame_error(frame_, fmt::format("dataset {}: expected float32, float64 or uint32", name));
  }

  using Filters = std::vector<H5Z_filter_t>;

  static Filters filters_of(hid_t creation) {
    Filters filters;
    const int count = H5Pget_nfilters(creation);
    for (int i = 0; i < count; ++i) {
      unsigned flags = 0, config = 0;
      std::size_t values = 0;
      filters.push_back(
          H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, &config));
    }
    return filters;
  }

  // Nothing of another file, and no filters but shuffle, gzip or both.
  void require_readable(hid_t creation, const std::string &name) const {
    const Filters filters = filters_of(creation);
    const bool is_readable = filters.empty() || filters == Filters{H5Z_FILTER_SHUFFLE} ||
                             filters == Filters{H5Z_FILTER_DEFLATE} ||
                             filters == Filters{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE};
    if (!is_readable || H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_external_count(creation) > 0)
      throw frame_error(frame_, fmt::format("dataset {}: expected values in this file, without compression "
                                            "or with gzip",
                                            name));
  }

  // HDF5 1.10 reads beyond values that are stored beside their description and are too few.
  static bool has_all_of_compact(hid_t dataset, hid_t creation, const std::array<hsize_t, 2> &sizes,
                                 std::size_t value_bytes) {
    return H5Pget_layout(creation) != H5D_COMPACT ||
           H5Dget_storage_size(dataset) == sizes[0] * sizes[1] * value_bytes;
  }

  bool has_whole_chunks(hid_t dataset, hid_t creation, const std::array<hsize_t, 2> &sizes,
                        std::size_t value_bytes) {
    const Filters filters = filters_of(creation);
    if (H5Pget_layout(creation) != H5D_CHUNKED)
      return filters.empty();
    std::array<hsize_t, 2> chunk{};
    if (H5Pget_chunk(creation, 2, chunk.data()) != 2 || chunk[0] < 1 || chunk[1] < 1 || chunk[0] > sizes[0] ||
        chunk[1] > sizes[1])
      return false;
    unsigned options = 0;
    if (H5Pget_chunk_opts(creation, &options) < 0 || options != 0) // chunks at the rim, without filters
      return false;
    require_memory(frame_.content.size() + sizes[0] * sizes[1] * value_bytes, Place{frame_.file},
                   fmt::format("{} x {} pixels and a chunk of them", sizes[1], sizes[0]));
    chunk_.resize(frame_.content.size()); // no chunk is longer
    const bool is_deflated = !filters.empty() && filters.back() == H5Z_FILTER_DEFLATE;
    const unsigned deflate_mask = is_deflated ? 1u << (filters.size() - 1) : 0;
    for (hsize_t row = 0; row < sizes[0]; row += chunk[0])
      for (hsize_t column = 0; column < sizes[1]; column += chunk[1])
        if (!is_whole_chunk(dataset, {row, column}, chunk[0] * chunk[1] * value_bytes, deflate_mask))
          return false;
    return true;
  }

  // HDF5 1.10 trusts that a chunk is as large as its values, and so is what a filter makes, and else reads
  // beyond it.
  bool is_whole_chunk(hid_t dataset, const std::array<hsize_t, 2> &at, hsize_t bytes, unsigned deflate_mask) {
    std::uint32_t left_out = 0;
    const std::size_t read_before = file_.value_bytes_read();
    if (H5Dread_chunk(dataset, H5P_DEFAULT, at.data(), &left_out, chunk_.data()) < 0)
      return false;
    const std::span stored(chunk_.data(), file_.value_bytes_read() - read_before);
    return (deflate_mask & ~left_out) != 0 ? inflates_to(stored, bytes) : stored.size() == bytes;
  }

  static bool inflates_to(std::span<const std::uint8_t> raw, hsize_t bytes) {
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    std::vector<std::uint8_t> whole(bytes);
    return inflater && libdeflate_zlib_decompress(inflater.get(), raw.data(), raw.size(), whole.data(),
                                                  whole.size(), nullptr) == LIBDEFLATE_SUCCESS;
  }

  // All together have no more than the file: several may be links to one, which are read one by one.
  std::uint64_t stored_bytes(hid_t dataset, const std::string &name) {
    const std::uint64_t bytes = H5Dget_storage_size(dataset);
    if (bytes > frame_.content.size() - stored_bytes_)
      throw frame_error(frame_, fmt::format("dataset {}: expected datasets of {} bytes together at most, as "
                                            "the file has",
                                            name, frame_.content.size()));
    stored_bytes_ += bytes;
    return bytes;
  }

  ReadChannel channel(hid_t dataset, const std::string &name, hid_t type, std::size_t values) const {
    // Not its attribute: HDF5 1.10 reads beyond damaged ones.
    const std::string unit = unit_of(name);
    if (type == H5T_NATIVE_FLOAT)
      return {name, unit, read<float>(dataset, type, values)};
    if (type == H5T_NATIVE_DOUBLE)
      return {name, unit, read<double>(dataset, type, values)};
    return {name, unit, read<std::uint32_t>(dataset, type, values)};
  }

  template <class Value>
  std::vector<Value> read(hid_t dataset, hid_t type, std::size_t count) const {
    std::vector<Value> values(count);
    check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return values;
  }

  const FrameBytes &frame_;
  Hdf5MemoryFile file_;
  std::uint64_t stored_bytes_ = 0; // of the datasets so far
  std::vector<std::uint8_t> chunk_;
};

} // namespace

ReadFrame read_h5(const FrameBytes &frame) {
  const Hdf5Turn turn;
  return H5Reader(frame).frame();
}

} // namespace pmdsim
