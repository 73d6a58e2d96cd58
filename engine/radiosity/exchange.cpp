#include "engine/radiosity/exchange.h"

#include <tbb/parallel_for.h>

namespace pmdsim {

Exchange::Exchange(const Elements &elements, const HemisphereScan &scan, std::uint32_t lines)
    : of_places_(elements.elements.size() * places_of_piece) {
  tbb::parallel_for(std::size_t{0}, of_places_.size(), [&](std::size_t number) {
    thread_local Sightings seen;
    const SurfacePlace &place = elements.elements[number / places_of_piece].places[number % places_of_piece];
    scan.at(place, turn_of(number), lines, seen);
    std::vector<Meeting> &meetings = of_places_[number];
    meetings.reserve(seen.face.size());
    for (std::size_t i = 0; i < seen.face.size(); ++i)
      meetings.push_back({seen.face[i], seen.u[i], seen.v[i], seen.length_m[i], seen.share[i], {}});
  });
}

void Exchange::set_tone(const BounceTone &tone) {
  const double turns_per_m = tone.turns_per_m();
  tbb::parallel_for(std::size_t{0}, of_places_.size(), [&](std::size_t number) {
    for (Meeting &meeting : of_places_[number])
      meeting.way = meeting.share * unit_phasor(turns_per_m * static_cast<double>(meeting.length_m));
  });
}

void Exchange::arrive(std::span<const std::array<Phasor, 3>> faces, std::span<Phasor> places) const {
  tbb::parallel_for(std::size_t{0}, of_places_.size(), [&](std::size_t number) {
    Phasor sum;
    for (const Meeting &meeting : of_places_[number])
      sum += meeting.way * at(faces[meeting.face], meeting.u, meeting.v);
    places[number] = sum;
  });
}

} // namespace pmdsim
