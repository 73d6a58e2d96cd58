#pragma once
// What the handles of the C interface stand for.

#include "host/capture/session.h"
#include "host/input/frame/frame_file.h"
#include "host/library/handles.h"
#include "host/library/pmdsim.h"
#include "host/output/files/channel.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim::library {

struct SimulatorObject {
  explicit SimulatorObject(const std::string &device) : session(device) {}

  std::mutex in_call; // by the call that it serves
  std::atomic<bool> cancelled{false};
  Session session;
  UriFiles scene_files = UriFiles::beside; // of setups that are loaded
  std::string description;                 // as pmdsim_simulator_describe() returned it last
};

// A frame: its channels' names and units live as long as it does.
struct FrameObject {
  FrameObject() = default;
  FrameObject(const FrameObject &) = delete;
  FrameObject &operator=(const FrameObject &) = delete;
  ~FrameObject();

  std::optional<TakenFrame> taken; // one or the other
  std::optional<ReadFrame> read;
  std::weak_ptr<Camera> camera; // whose memory it is in
  ChannelSet channels;
  std::vector<std::string> names; // beside the channels
  std::string report = "{}";
};

Handles<pmdsim_simulator, SimulatorObject> &simulators();
Handles<pmdsim_frame, FrameObject> &frames();

// The frame as a handle. Throws what adding it does.
pmdsim_frame *add_frame(std::shared_ptr<FrameObject> frame);

// A simulator while a call uses it. Throws Refusal: no simulator, or one in another call.
class InCall {
public:
  explicit InCall(const pmdsim_simulator *handle);

  SimulatorObject &operator*() const { return *object_; }
  SimulatorObject *operator->() const { return object_.get(); }

private:
  std::shared_ptr<SimulatorObject> object_;
  std::unique_lock<std::mutex> lock_;
};

} // namespace pmdsim::library
