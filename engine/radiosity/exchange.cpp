#include "engine/radiosity/exchange.h"

#include "engine/radiosity/hemisphere.h"

#include <tbb/parallel_for.h>

namespace pmdsim {

Exchange::Exchange(const Elements &elements, const FacetTree &tree, std::uint32_t rays_per_edge)
    : per_place_(std::size_t{rays_per_edge} * rays_per_edge),
      meetings_(elements.elements.size() * places_of_piece * per_place_) {
  tbb::parallel_for(std::size_t{0}, elements.elements.size() * places_of_piece, [&](std::size_t number) {
    const SurfacePlace &place = elements.elements[number / places_of_piece].places[number % places_of_piece];
    const Hemisphere hemisphere(place.normal, turn_of(number), rays_per_edge);
    const glm::dvec3 from_m = place.position_m + elements.clearance_m() * place.normal;
    Meeting *next = meetings_.data() + number * per_place_;
    for (std::size_t row = 0; row < rays_per_edge; row += packet_rows)
      for (std::size_t column = 0; column < rays_per_edge; column += packet_columns) {
        RayPacket packet;
        for (std::size_t i = 0; i < packet_rays; ++i)
          packet.directions[i] =
              hemisphere.direction(glm::uvec2(column + i % packet_columns, row + i / packet_columns));
        tree.trace(from_m, packet);
        for (std::size_t i = 0; i < packet_rays; ++i) {
          const bool is_lit = packet.facet[i] != no_facet &&
                              elements.facets[packet.facet[i]].elements[packet.side[i]] != no_element;
          *next++ = is_lit ? Meeting{static_cast<std::uint32_t>(face_of(packet.facet[i], packet.side[i])),
                                     packet.u[i], packet.v[i], packet.length_m[i]}
                           : Meeting{no_facet, 0.0f, 0.0f, 0.0f};
        }
      }
  });
}

void Exchange::set_tone(const BounceTone &tone) {
  turns_.resize(meetings_.size());
  const double turns_per_m = tone.turns_per_m();
  const float share = 1.0f / static_cast<float>(per_place_);
  tbb::parallel_for(std::size_t{0}, meetings_.size() / per_place_, [&](std::size_t place) {
    for (std::size_t i = place * per_place_; i < (place + 1) * per_place_; ++i)
      turns_[i] = share * unit_phasor(turns_per_m * static_cast<double>(meetings_[i].length_m));
  });
}

void Exchange::arrive(std::span<const std::array<Phasor, 3>> faces, std::span<Phasor> places) const {
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t place) {
    Phasor sum;
    for (std::size_t i = place * per_place_; i < (place + 1) * per_place_; ++i)
      if (const Meeting &met = meetings_[i]; met.face != no_facet)
        sum += turns_[i] * at(faces[met.face], met.u, met.v);
    places[place] = sum;
  });
}

} // namespace pmdsim
