#include "host/output/files/h5_writer.h"

#include "engine/model/error.h"
#include "host/hdf5/hdf5.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <hdf5_hl.h>
#include <limits>
#include <memory>
#include <numeric>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pmdsim {
namespace {

// Large chunks go into the file as they are, past HDF5's cache, and small parts can still be read.
constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
constexpr std::size_t page_bytes = 4096;
constexpr unsigned most_links = 65535;                       // that HDF5 keeps in one place
constexpr std::size_t room_for_names = std::size_t{1} << 18; // and attributes, and what HDF5 needs

using Bytes = std::unique_ptr<void, decltype([](void *bytes) { std::free(bytes); })>;

// The file as HDF5 builds it in memory, which is ours once it is closed.
struct Image {
  std::size_t expected_bytes;
  std::size_t room = 0;
  std::size_t size = 0;
  Bytes bytes{};

  std::string_view text() const { return {static_cast<const char *>(bytes.get()), size}; }
};

// HDF5 asks for more memory again and again, page by page, so that the file ends where its content does.
void *with_more_room(void *bytes, std::size_t size, H5FD_file_image_op_t, void *of) {
  Image &image = *static_cast<Image *>(of);
  if (bytes && size <= image.room)
    return bytes;
  const std::size_t room = std::max(image.expected_bytes, size + size / 2);
  void *const more = std::realloc(bytes, room);
  if (more)
    image.room = room;
  return more;
}

herr_t hand_over(void *bytes, H5FD_file_image_op_t when, void *to) {
  Bytes owned(bytes);
  if (when == H5FD_FILE_IMAGE_OP_FILE_CLOSE)
    static_cast<Image *>(to)->bytes = std::move(owned);
  return 0;
}

H5FD_file_image_callbacks_t memory_of(Image &image) {
  return {.image_malloc = [](std::size_t size, H5FD_file_image_op_t, void *) { return std::malloc(size); },
          .image_memcpy = nullptr,
          .image_realloc = with_more_room,
          .image_free = hand_over,
          .udata_copy = [](void *of) { return of; },
          .udata_free = [](void *) -> herr_t { return 0; },
          .udata = &image};
}

template <class Value>
hid_t type_of() {
  if constexpr (std::is_same_v<Value, float>)
    return H5T_IEEE_F32LE;
  else if constexpr (std::is_same_v<Value, double>)
    return H5T_IEEE_F64LE;
  else
    return H5T_STD_U32LE;
}

class H5File {
public:
  // Builds in `image`, which gets the file by finish(). `path` is for errors.
  H5File(std::string path, Image &image) : path_(std::move(path)), image_(image) {
    const Hdf5Handle access = made(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5FD_file_image_callbacks_t callbacks = memory_of(image);
    check(H5Pset_fapl_core(access.id(), page_bytes, false));
    check(H5Pset_file_image_callbacks(access.id(), &callbacks));
    const Hdf5Handle creation = made(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    // No times: the same frame is the same bytes. And the channels stay in their order.
    check(H5Pset_obj_track_times(creation.id(), false));
    check(H5Pset_link_creation_order(creation.id(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
    // And their names in one place: no trees, which are more than a few names are worth.
    check(H5Pset_link_phase_change(creation.id(), most_links, 0));
    file_ = made(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose);
  }

  hid_t root() const { return file_.id(); }

  // In chunks of whole rows, the first of `sizes`.
  template <class Value>
  Hdf5Handle add_dataset(const std::string &name, const std::vector<hsize_t> &sizes,
                         std::span<const Value> values) const {
    const auto rank = static_cast<int>(sizes.size());
    const Hdf5Handle space = made(H5Screate_simple(rank, sizes.data(), nullptr), H5Sclose);
    const Hdf5Handle creation = made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_obj_track_times(creation.id(), false));
    if (rank > 1) {
      check(H5Pset_chunk(creation.id(), rank, chunk_of(sizes, sizeof(Value)).data()));
      if constexpr (std::is_floating_point_v<Value>)
        check(H5Pset_fill_value(creation.id(), type_of<Value>(), &not_a_number<Value>));
    }
    const Hdf5Handle access = made(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
    check(H5Pset_chunk_cache(access.id(), 0, 0, H5D_CHUNK_CACHE_W0_DEFAULT));
    Hdf5Handle dataset = made(H5Dcreate2(root(), name.c_str(), type_of<Value>(), space.id(), H5P_DEFAULT,
                                         creation.id(), access.id()),
                              H5Dclose);
    check(H5Dwrite(dataset.id(), type_of<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    return dataset;
  }

  void add_text(hid_t to, const char *name, const std::string &text) const {
    const Hdf5Handle type = made(H5Tcopy(H5T_C_S1), H5Tclose);
    check(H5Tset_size(type.id(), text.size() + 1));
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8));
    const Hdf5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
    write_attribute(to, name, type.id(), space.id(), text.c_str());
  }

  template <class Value>
  void add_number(hid_t to, const char *name, Value value) const {
    const Hdf5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
    write_attribute(to, name, type_of<Value>(), space.id(), &value);
  }

  void add_numbers(hid_t to, const char *name, const std::vector<double> &values) const {
    const hsize_t count = values.size();
    const Hdf5Handle space = made(H5Screate_simple(1, &count, nullptr), H5Sclose);
    write_attribute(to, name, type_of<double>(), space.id(), values.data());
  }

  // The indices from 0 to `count` - 1, to be attached to datasets.
  Hdf5Handle add_scale(const char *name, std::uint32_t count, const char *about) const {
    std::vector<std::uint32_t> indices(count);
    std::iota(indices.begin(), indices.end(), 0u);
    Hdf5Handle scale = add_dataset<std::uint32_t>(name, {count}, indices);
    check(H5DSset_scale(scale.id(), name));
    add_text(scale.id(), "units", "");
    add_text(scale.id(), "long_name", about);
    return scale;
  }

  void finish() {
    hsize_t size = 0;
    check(H5Fflush(root(), H5F_SCOPE_GLOBAL));
    check(H5Fget_filesize(root(), &size));
    check(file_.close());
    image_.size = size;
  }

  void check(herr_t result) const {
    if (result >= 0)
      return;
    const Hdf5Reason reason = hdf5_reason();
    throw write_error(path_, reason.text, reason.lacks_memory ? Lacking::memory : Lacking::other);
  }

private:
  template <class Value>
  static constexpr Value not_a_number = std::numeric_limits<Value>::quiet_NaN();

  Hdf5Handle made(hid_t id, herr_t (*close)(hid_t)) const {
    check(id < 0 ? -1 : 0);
    return {id, close};
  }

  // Of about the same size, as HDF5 writes the last one whole, too.
  static std::vector<hsize_t> chunk_of(std::vector<hsize_t> sizes, std::size_t bytes_of_value) {
    const hsize_t row_bytes = sizes[1] * bytes_of_value, rows = sizes[0];
    const hsize_t chunks = (rows * row_bytes + chunk_bytes - 1) / chunk_bytes;
    sizes[0] = (rows + chunks - 1) / chunks;
    return sizes;
  }

  void write_attribute(hid_t to, const char *name, hid_t type, hid_t space, const void *value) const {
    const Hdf5Handle attribute = made(H5Acreate2(to, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(H5Awrite(attribute.id(), type, value));
  }

  std::string path_;
  Image &image_;
  Hdf5Handle file_;
};

void add_label(const H5File &h5, const FrameLabel &label) {
  const hid_t root = h5.root();
  h5.add_text(root, "program", "pmdsim");
  h5.add_text(root, "version", PMDSIM_VERSION);
  h5.add_text(root, "sensor", label.sensor.name);
  h5.add_number(root, "frame", label.frame);
  h5.add_number(root, "time_s", label.time_s);
  h5.add_numbers(root, "modulation_hz", label.sensor.modulation_hz);
  h5.add_numbers(root, "ambiguity_m", ambiguities_m(label.sensor));
  h5.add_text(root, "camera", camera_json(label.sensor).dump());
}

void add_channel(const H5File &h5, const Channel &channel, const glm::uvec2 &resolution,
                 const std::array<hid_t, 2> &scales) {
  std::visit(
      [&](auto values) {
        using Value = decltype(values)::value_type;
        const Hdf5Handle dataset =
            h5.add_dataset<Value>(channel.name(), {resolution.y, resolution.x}, values);
        for (unsigned i = 0; i < scales.size(); ++i)
          h5.check(H5DSattach_scale(dataset.id(), scales[i], i));
        h5.add_text(dataset.id(), "units", channel.unit);
        h5.add_text(dataset.id(), "long_name", channel.about);
        if constexpr (std::is_floating_point_v<Value>)
          h5.add_number(dataset.id(), "_FillValue", std::numeric_limits<Value>::quiet_NaN());
      },
      written_values(channel));
}

void add_channels(const H5File &h5, const ChannelSet &set) {
  const Hdf5Handle row =
      h5.add_scale("row", set.resolution.y, "row, 0 at the top; a number is a pixel's centre");
  const Hdf5Handle column =
      h5.add_scale("column", set.resolution.x, "column, 0 at the left; a number is a pixel's centre");
  for (const Channel &channel : set.channels)
    add_channel(h5, channel, set.resolution, {row.id(), column.id()});
}

Image image_of(const std::string &path, const ChannelSet &set, const FrameLabel &label) {
  std::size_t bytes = room_for_names;
  for (const Channel &channel : set.channels)
    bytes += std::visit([](auto values) { return values.size_bytes(); }, written_values(channel));
  Image image{bytes};
  const Hdf5Turn turn;
  H5File h5(path, image);
  add_label(h5, label);
  add_channels(h5, set);
  h5.finish(); // nothing else of it is open any more
  return image;
}

} // namespace

void write_h5(OutputFile &file, const ChannelSet &channels, const FrameLabel &label) {
  const Image image = image_of(file.path().string(), channels, label);
  file.reserve(image.size);
  file.write(image.text());
}

} // namespace pmdsim
