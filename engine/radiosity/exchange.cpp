#include "engine/radiosity/exchange.h"

#include "engine/radiosity/line_light.h"

#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

// What scatters light: the element of a face, and how much of it.
struct Scattering {
  std::uint32_t element;
  float reflectivity;
};

std::vector<Scattering> scattering_of(const Elements &elements) {
  std::vector<Scattering> faces;
  for (const Facet &facet : elements.facets)
    for (const std::uint32_t element : facet.elements)
      faces.push_back({element, facet.reflectivity});
  faces.push_back({no_element, 0.0f}); // where nothing is seen
  return faces;
}

// The entries of a place, while they are summed up.
class OpenRow {
public:
  void reserve(std::size_t elements) {
    weights_.resize(elements);
    is_open_.resize(elements);
  }
  std::size_t size() const { return open_.size(); }

  void add(const SeenLine &line, const LineWays &ways, const std::vector<Scattering> &faces) {
    for (std::size_t i = 0; i < bins_of_line; ++i) {
      const auto [element, reflectivity] = faces[static_cast<std::size_t>(line.face[i])];
      if (element == no_element)
        continue;
      if (is_open_[element] == 0) {
        is_open_[element] = 1;
        open_.push_back(element);
      }
      const Phasor way = reflectivity * Phasor{ways.re[i], ways.im[i]};
      TriangleLight &sum = weights_[element];
      sum.at += way;
      sum.by_u += line.u[i] * way;
      sum.by_v += line.v[i] * way;
    }
  }

  // And starts again.
  template <class Visit>
  void close(const Visit &visit) {
    for (const std::uint32_t element : open_) {
      visit(element, weights_[element]);
      weights_[element] = {};
      is_open_[element] = 0;
    }
    open_.clear();
  }

private:
  std::vector<TriangleLight> weights_;
  std::vector<std::uint8_t> is_open_;
  std::vector<std::uint32_t> open_;
};

} // namespace

Exchange::Exchange(const Elements &elements, const HemisphereScan &scan, std::uint32_t lines,
                   const std::vector<BounceTone> &tones, const Exitance &direct)
    : tones_(tones.size()) {
  const std::vector<Scattering> faces = scattering_of(elements);
  const std::size_t places = elements.elements.size() * places_of_piece;
  for (OfTone &of_tone : tones_) {
    of_tone.first.resize(places);
    of_tone.places.resize(places);
  }
  const LineLightLoops &loops = line_light_loops();
  tbb::parallel_for(std::size_t{0}, places, [&](std::size_t number) {
    thread_local std::vector<OpenRow> rows;
    rows.resize(tones.size());
    for (OpenRow &row : rows)
      row.reserve(elements.elements.size());
    const SurfacePlace &place = elements.elements[number / places_of_piece].places[number % places_of_piece];
    scan.at(place, turn_of(number), lines, [&](const SeenLine &line) {
      LineWays ways;
      for (std::size_t t = 0; t < tones.size(); ++t) {
        loops.find_ways(line, tones[t].turns_per_m(), ways);
        tones_[t].first[number] += loops.add_light(line, ways, direct.of_tone(t).data()).arrives;
        rows[t].add(line, ways, faces);
      }
    });
    for (std::size_t t = 0; t < tones.size(); ++t) {
      tones_[t].places[number].reserve(rows[t].size());
      rows[t].close([&](std::uint32_t element, const TriangleLight &weights) {
        tones_[t].places[number].push_back({element, weights});
      });
    }
  });
}

void Exchange::arrive(std::size_t tone, std::span<const TriangleLight> elements,
                      std::span<Phasor> places) const {
  tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t number) {
    Phasor sum;
    for (const auto &[element, weights] : tones_[tone].places[number]) {
      const TriangleLight &light = elements[element];
      sum += weights.at * light.at + weights.by_u * light.by_u + weights.by_v * light.by_v;
    }
    places[number] = sum;
  });
}

} // namespace pmdsim
