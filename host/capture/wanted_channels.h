#pragma once
// The channels that somebody asks for, and what a frame has to be made of so that these have the bits that
// they have in a frame of all channels.

#include "engine/model/accuracy.h"
#include "engine/model/channels.h"
#include "host/input/setup/setup.h"

#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

class WantedChannels {
public:
  // All there are, but for those on demand (is_on_demand() of engine/model/channels.h).
  WantedChannels() = default;
  // By the names of files, without the numbers of taps; of several frequencies with a prefix for one of them,
  // "f1.distance_m", or without for all; "normals" and "rays", each of three, and "all" of those that are not
  // on demand. Of `own_names` each counts, too: channels that a command makes
  // itself. Throws Error (usage) for a name that is none, or where there is no name at all; it lists what
  // there is.
  explicit WantedChannels(const std::vector<std::string> &names,
                          const std::vector<std::string> &own_names = {});

  // But for those on demand.
  bool are_all() const { return are_all_; }
  // In the order of the alphabet; none where none was given.
  const std::vector<std::string> &names() const { return names_; }

  // Whether a channel is wanted; one of a command; a row, of some frequency; and any that is of taps.
  bool has(const ChannelIndex &channel) const;
  bool has_own(const std::string &name) const;
  bool has(const ChannelRow &row) const;
  bool have_taps() const;
  // Whether there may be a picture of any.
  bool have_previews() const;

  // The same and one more, of all frequencies; nothing changes where all are wanted.
  WantedChannels with(const ChannelRow &row) const;

  // Throws Error (usage) where no frame of the setup, measured like that, has one of them, or where frames of
  // a sensor have none at all; it lists what there is.
  void require_in(const Setup &setup, const Accuracy &accuracy) const;

private:
  struct Wanted {
    const ChannelRow *row;                // null: a command's own
    std::optional<std::size_t> frequency; // nothing: all
    std::string name;
  };

  static bool is_there(const Wanted &wanted, const Setup &setup, const Sensor &sensor,
                       const Accuracy &accuracy);

  void add(const std::string &name);

  bool are_all_ = true;
  std::vector<Wanted> wanted_;
  std::vector<std::string> names_, own_names_;
};

// Whether frames of the sensor have such channels, as far as the setup tells; error_bound_m: whether they
// may.
bool has_channel(const ChannelRow &row, const Sensor &sensor, const Bounces &bounces);

// How much of a frame has to be made; each includes those before it.
enum class FramePart {
  truth,        // what the lens sees: no light but one source
  visibility,   // and which diodes reach it
  direct_light, // the light of all diodes, without bounces
  light,        // all light, noiseless
  electrons,    // what the camera makes of it
};

// The least part of an exposure that the wanted channels of the sensor are in.
FramePart part_of(const WantedChannels &wanted, const Sensor &sensor, const Bounces &bounces,
                  const Accuracy &accuracy);

// Whether noiseless channels are left out. The device then counts electrons strip by strip, of the same light
// as beside them (Extras::electrons_of_polar), which is not quite the light of sensors that have none: all
// that have electronics must have them.
bool leaves_noiseless(const WantedChannels &wanted, const std::vector<Sensor> &sensors);

// The sensor without what the part and the wanted channels do not need.
Sensor reduced_to(const WantedChannels &wanted, FramePart part, bool leaves_noiseless, Sensor sensor);

// Gives the channels of the light, in a frame that was made without bounces or electrons, the names that they
// have beside these. `sensor` is the setup's.
void name_light(FramePart part, const Sensor &sensor, Measurement &frame);

// Moves the values of channels that are not wanted from one frame to another, which need not be of a kind.
void move_unwanted(const WantedChannels &wanted, Measurement &from, Measurement &to);
// The values of all channels that the other one has not.
void move_missing(Measurement &from, Measurement &to);

} // namespace pmdsim
