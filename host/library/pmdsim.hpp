// pmdsim.hpp: the C++ face of libpmdsim, on top of pmdsim.h and nothing else, so that compiler, standard
// library and flags may differ from those that the library was built with. C++17.
//
//     pmdsim::Simulator simulator;
//     simulator.load("room.json");
//     const pmdsim::Frame frame = simulator.render();
//     const pmdsim::Channel distance = frame["distance_m"]; // rows x columns floats, row 0 at the top
//
// Errors are pmdsim::Error. Units, shapes, threads and lifetimes are those of pmdsim.h.
#ifndef PMDSIM_HPP
#define PMDSIM_HPP

#include "pmdsim.h"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

class Error : public std::runtime_error {
public:
  // Of this thread's last call, which failed with that status.
  explicit Error(pmdsim_status status)
      : std::runtime_error(pmdsim_error_message()), status_(status), file_(pmdsim_error_file()),
        place_(pmdsim_error_place()) {}

  pmdsim_status status() const { return status_; }
  // The file that is wrong and the place in it, a JSON pointer or "LINE:COLUMN"; empty where there is none.
  const std::string &file() const { return file_; }
  const std::string &place() const { return place_; }

private:
  pmdsim_status status_;
  std::string file_, place_;
};

inline void check(pmdsim_status status) {
  if (status != PMDSIM_OK)
    throw Error(status);
}

// A view that lives as long as its frame.
struct Channel : pmdsim_channel {
  Channel() : pmdsim_channel{sizeof(pmdsim_channel), nullptr, nullptr, PMDSIM_FLOAT32, 0, 0, nullptr} {}

  std::size_t size() const { return std::size_t{rows} * columns; }
  // Throws std::logic_error where it holds the other type.
  const float *floats() const { return static_cast<const float *>(values_of(PMDSIM_FLOAT32)); }
  const std::uint32_t *ids() const { return static_cast<const std::uint32_t *>(values_of(PMDSIM_UINT32)); }

private:
  const void *values_of(pmdsim_type wanted) const {
    if (type != wanted)
      throw std::logic_error(std::string("channel ") + name + " holds values of the other type");
    return values;
  }
};

class Frame {
public:
  // Of a handle that is its own from here on.
  explicit Frame(pmdsim_frame *handle) : handle_(handle) {}
  // As pmdsim_frame_read().
  static Frame read(const std::string &file) {
    pmdsim_frame *handle = nullptr;
    check(pmdsim_frame_read(file.c_str(), &handle));
    return Frame(handle);
  }
  ~Frame() { pmdsim_frame_destroy(handle_); }
  Frame(Frame &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Frame &operator=(Frame &&other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  // Throws Error where the frame has no such channel.
  Channel operator[](const std::string &name) const {
    Channel channel;
    check(pmdsim_frame_find(handle_, name.c_str(), &channel));
    return channel;
  }
  std::vector<Channel> channels() const {
    std::size_t count = 0;
    check(pmdsim_frame_channel_count(handle_, &count));
    std::vector<Channel> all(count);
    for (std::size_t i = 0; i < count; ++i)
      check(pmdsim_frame_channel(handle_, i, &all[i]));
    return all;
  }
  std::string report() const {
    const char *json = nullptr;
    check(pmdsim_frame_report(handle_, &json));
    return json;
  }
  // rows x columns x 3.
  std::vector<double> directions() const {
    std::vector<double> all(3 * channels().front().size());
    check(pmdsim_frame_directions(handle_, all.data(), all.size()));
    return all;
  }

private:
  pmdsim_frame *handle_;
};

struct RenderOptions : pmdsim_render_options {
  RenderOptions() : pmdsim_render_options{} { struct_size = sizeof(pmdsim_render_options); }
};

struct Mesh : pmdsim_mesh {
  Mesh() : pmdsim_mesh{} { struct_size = sizeof(pmdsim_mesh); }
};

class Simulator {
public:
  explicit Simulator(const std::string &device = "") {
    check(pmdsim_simulator_create(device.c_str(), &handle_));
  }
  ~Simulator() { pmdsim_simulator_destroy(handle_); }
  Simulator(Simulator &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Simulator &operator=(Simulator &&other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }

  void allow_outside(bool allowed) { check(pmdsim_simulator_allow_outside(handle_, allowed ? 1 : 0)); }
  void load(const std::string &file) { check(pmdsim_simulator_load(handle_, file.c_str())); }
  void load_text(const std::string &text, const std::string &directory = "") {
    check(pmdsim_simulator_load_text(handle_, text.data(), text.size(), directory.c_str()));
  }
  void load_mesh(const std::string &text, const Mesh &mesh, const std::string &directory = "") {
    check(pmdsim_simulator_load_mesh(handle_, text.data(), text.size(), directory.c_str(), &mesh));
  }
  void set(const std::string &json) { check(pmdsim_simulator_set(handle_, json.c_str())); }
  std::string describe() const {
    const char *json = nullptr;
    check(pmdsim_simulator_describe(handle_, &json));
    return json;
  }
  void cancel() noexcept { pmdsim_simulator_cancel(handle_); }

  Frame render(std::uint32_t sensor = 0, std::uint32_t frame = 0, const RenderOptions &options = {}) {
    pmdsim_frame *handle = nullptr;
    check(pmdsim_render(handle_, sensor, frame, &options, &handle));
    return Frame(handle);
  }

private:
  pmdsim_simulator *handle_ = nullptr;
};

} // namespace pmdsim

#endif // PMDSIM_HPP
