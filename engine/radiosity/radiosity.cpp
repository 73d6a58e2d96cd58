#include "engine/radiosity/radiosity.h"

#include "engine/model/error.h"
#include "engine/radiosity/direct_irradiance.h"
#include "engine/radiosity/exchange.h"
#include "engine/radiosity/krylov.h"
#include "engine/surfaces/facet_tree.h"
#include "engine/surfaces/grading.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr double solved_residual =
    1e-4; // of what bounces; one more product brings it down by as much as light loses
constexpr std::uint32_t most_products = 40;
constexpr int most_facet_cuts = 3;           // of a facet, each to half its size
constexpr std::size_t most_facets = 200'000; // that are cut

// Irradiance at the places of one piece, tone by tone.
using PieceLight = std::vector<std::array<Phasor, places_of_piece>>;

// A linear function through the Gauss points, and what is found at the centre beyond it.
struct Linear {
  std::array<Phasor, 3> corners;
  Phasor missed;
};

Linear linear_of(const std::array<Phasor, places_of_piece> &places, const std::array<glm::vec3, 3> &weights) {
  Linear made;
  for (std::size_t i = 0; i < 3; ++i)
    made.corners[i] = weights[i].x * places[0] + weights[i].y * places[1] + weights[i].z * places[2];
  made.missed = places[3] - (1.0f / 3.0f) * (places[0] + places[1] + places[2]);
  return made;
}

// The weights of a facet's own Gauss points at its corners.
constexpr std::array<glm::vec3, 3> own_weights{glm::vec3{5.0f, -1.0f, -1.0f} / 3.0f,
                                               glm::vec3{-1.0f, 5.0f, -1.0f} / 3.0f,
                                               glm::vec3{-1.0f, -1.0f, 5.0f} / 3.0f};

class Solver {
public:
  Solver(const Scene &scene, const std::vector<Illuminator> &illuminators, Shadows shadows,
         const std::vector<BounceTone> &tones, const Fineness &fineness)
      : scene_(scene), illuminators_(illuminators), shadows_(shadows), tones_(tones), fineness_(fineness),
        elements_(make_elements(scene, fineness.element_m)) {}

  Radiosity solve(const Bounces &bounces) {
    light_facets();
    Exitance exitance = direct_exitance();
    const std::vector<Sums> direct = sums_of(exitance);
    auto scan = std::make_unique<const HemisphereScan>(scene_, elements_, fineness_.bins);
    std::size_t lines = 0;
    std::uint32_t products = 0;
    if (bounces.count > 1) {
      const ElementLight layout(elements_);
      const Exchange exchange(elements_, layout, *scan, fineness_.lines, tones_, exitance);
      lines = elements_.elements.size() * places_of_piece * fineness_.lines;
      std::vector<std::uint32_t> of_tones(tones_.size());
      tbb::parallel_for(std::size_t{0}, tones_.size(), [&](std::size_t t) {
        of_tones[t] = add_bounces(layout, exchange, bounces, t, exitance);
      });
      products = std::accumulate(of_tones.begin(), of_tones.end(), 0u);
      if (bounces.count == all_bounces)
        refuse_divergence(layout, *scan);
    }
    std::vector<float> off = off_by(direct, sums_of(exitance));
    return {std::move(elements_), std::move(scan), std::move(exitance), std::move(off), lines, products};
  }

private:
  // Direct light of all facets, cut where it varies too much; against the tree of what is not cut yet.
  void light_facets() {
    const FacetTree whole(scene_, elements_);
    grade_elements(scene_, whole, elements_);
    const DirectIrradiance direct(illuminators_, elements_.origin_m,
                                  shadows_ == Shadows::automatic ? &whole : nullptr, elements_.clearance_m());
    of_facets_.resize(elements_.facets.size());
    std::vector<std::uint32_t> fresh(elements_.facets.size());
    std::iota(fresh.begin(), fresh.end(), 0u);
    light(direct, fresh);
    for (int cut = 0; cut < most_facet_cuts; ++cut) {
      const std::vector<std::uint32_t> rough = rough_facets(fresh);
      if (rough.empty() || elements_.facets.size() + 3 * rough.size() > most_facets)
        break;
      const auto first = static_cast<std::uint32_t>(elements_.facets.size());
      split_facets(scene_, elements_, rough);
      fresh = rough;
      for (std::uint32_t i = first; i < elements_.facets.size(); ++i)
        fresh.push_back(i);
      of_facets_.resize(elements_.facets.size());
      light(direct, fresh);
    }
  }

  // At the places of a piece, or at one that stands for all of them.
  PieceLight light_of(const DirectIrradiance &direct, std::span<const SurfacePlace> places) const {
    PieceLight light(tones_.size());
    std::vector<Phasor> of_place(tones_.size());
    for (std::size_t i = 0; i < places_of_piece; ++i) {
      if (i < places.size())
        direct.at(places[i], tones_, of_place);
      for (std::size_t t = 0; t < tones_.size(); ++t)
        light[t][i] = of_place[t];
    }
    return light;
  }

  // Small facets by their centres alone.
  void light(const DirectIrradiance &direct, const std::vector<std::uint32_t> &facets) {
    tbb::parallel_for(std::size_t{0}, facets.size(), [&](std::size_t i) {
      const Facet &facet = elements_.facets[facets[i]];
      for (std::size_t side = 0; side < 2; ++side) {
        if (facet.elements[side] == no_element)
          continue;
        auto places = places_of(facet, side);
        of_facets_[facets[i]][side] =
            light_of(direct, facet.whole ? std::span(&places[3], 1) : std::span(places));
      }
    });
  }

  double light_of_all() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < elements_.facets.size(); ++i)
      for (std::size_t side = 0; side < 2; ++side)
        if (elements_.facets[i].elements[side] != no_element)
          sum += elements_.facets[i].area_m2() *
                 static_cast<double>(elements_.facets[i].reflectivity * abs(of_facets_[i][side][0][3]));
    return sum;
  }

  std::vector<std::uint32_t> rough_facets(const std::vector<std::uint32_t> &among) const {
    const double most = fineness_.facet_part * light_of_all();
    std::vector<std::uint32_t> rough;
    for (const std::uint32_t i : among) {
      const Facet &facet = elements_.facets[i];
      double missed = 0.0;
      for (std::size_t side = 0; side < 2; ++side)
        if (facet.elements[side] != no_element)
          missed = std::max(missed,
                            static_cast<double>(abs(linear_of(of_facets_[i][side][0], own_weights).missed)));
      if (!facet.whole && missed * facet.area_m2() * static_cast<double>(facet.reflectivity) > most)
        rough.push_back(i);
    }
    return rough;
  }

  Exitance direct_exitance() const {
    Exitance exitance(elements_.facets.size(), tones_.size());
    for_each_lit_side([&](std::size_t face, const Facet &facet, std::size_t side) {
      const PieceLight &light = of_facets_[face / 2][side];
      for (std::size_t t = 0; t < tones_.size(); ++t)
        add(exitance.of(face, t), facet, linear_of(light[t], own_weights));
    });
    return exitance;
  }

  // Of a tone: all light that leaves, W, and the root of the sum of squares of what facets miss of it.
  struct Sums {
    double light_w = 0.0, missed_w = 0.0;
  };

  std::vector<Sums> sums_of(const Exitance &exitance) const {
    std::vector<Sums> sums(tones_.size());
    for (std::size_t face = 0; face < 2 * elements_.facets.size(); ++face)
      for (std::size_t t = 0; t < sums.size(); ++t) {
        const FaceLight &light = exitance.of(face, t);
        const double area_m2 = elements_.facets[face / 2].area_m2(),
                     missed_w = area_m2 * static_cast<double>(light.missed);
        sums[t].light_w += area_m2 * static_cast<double>(abs(light_at_centre(face, light)));
        sums[t].missed_w += missed_w * missed_w;
      }
    for (Sums &of_tone : sums)
      of_tone.missed_w = std::sqrt(of_tone.missed_w);
    return sums;
  }

  // Facets are off by chance, one this way and one that way; what they are off by bounces as light does.
  static std::vector<float> off_by(const std::vector<Sums> &direct, const std::vector<Sums> &all) {
    std::vector<float> off;
    for (std::size_t t = 0; t < all.size(); ++t)
      off.push_back(all[t].light_w > 0.0 && direct[t].light_w > 0.0
                        ? static_cast<float>(all[t].missed_w / direct[t].light_w)
                        : 0.0f);
    return off;
  }

  Phasor light_at_centre(std::size_t face, const FaceLight &light) const {
    const auto &corners = elements_.facets[face / 2].in_triangle;
    const CornerWeights centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    return light_at(light.leaving, static_cast<float>(centre.y), static_cast<float>(centre.z));
  }

  // What a facet sends of light that arrives on it.
  static void add(FaceLight &to, const Facet &facet, const Linear &irradiance) {
    to.leaving +=
        facet.reflectivity * times(glm::mat3(triangle_from_corners(facet)), irradiance.corners.data());
    to.missed = std::hypot(to.missed, facet.reflectivity * abs(irradiance.missed));
  }

  template <class Visit>
  void for_each_lit_side(const Visit &visit) const {
    tbb::parallel_for(std::size_t{0}, elements_.facets.size(), [&](std::size_t i) {
      for (std::size_t side = 0; side < 2; ++side)
        if (elements_.facets[i].elements[side] != no_element)
          visit(2 * i + side, elements_.facets[i], side);
    });
  }

  // Adds to the exitance of a tone what has bounced; returns the number of products.
  std::uint32_t add_bounces(const ElementLight &layout, const Exchange &exchange, const Bounces &bounces,
                            std::size_t tone, Exitance &exitance) const {
    const std::vector<Phasor> &first = exchange.first(tone);
    std::vector<Phasor> values = first;
    std::uint32_t products = 1;
    const auto add_to_first = [&](const std::vector<Phasor> &more) {
      for (std::size_t i = 0; i < first.size(); ++i)
        values[i] = first[i] + more[i];
    };
    if (bounces.count == all_bounces) {
      const auto bounce = [&](const std::vector<Phasor> &last) {
        return exchange.bounced(tone, layout.spread(last), false);
      };
      const KrylovSolution sum =
          solve_series(layout.without_last_places(first), bounce, solved_residual, most_products);
      add_to_first(exchange.bounced(tone, layout.spread(sum.x), true));
      products += sum.products;
    } else {
      for (std::uint32_t n = 2; n < bounces.count; ++n, ++products)
        add_to_first(exchange.bounced(tone, layout.spread(values), true));
    }
    add_scattered(layout, values, tone, exitance);
    return products;
  }

  // What faces send of light that arrives on elements.
  void add_scattered(const ElementLight &layout, const std::vector<Phasor> &values, std::size_t tone,
                     Exitance &exitance) const {
    const std::vector<TriangleLight> light = layout.spread(values);
    for_each_lit_side([&](std::size_t face, const Facet &facet, std::size_t side) {
      const std::uint32_t element = facet.elements[side];
      TriangleLight arrives = light[element];
      if (facet.whole) {
        const glm::vec2 tilt = layout.tilt_of(facet, side);
        arrives = {light_at(arrives, tilt.x, tilt.y), {}, {}};
      }
      FaceLight &to = exitance.of(face, tone);
      to.leaving += facet.reflectivity * arrives;
      to.missed = std::hypot(to.missed, facet.reflectivity * abs(layout.missed(values, element)));
    });
  }

  // At rest, without phase, light that neither leaves the scene nor is absorbed adds up without end.
  void refuse_divergence(const ElementLight &layout, const HemisphereScan &scan) const {
    constexpr float harmless = 0.99f;
    constexpr double stays = 1.0 - 1e-4;
    if (std::ranges::none_of(elements_.facets,
                             [](const Facet &facet) { return facet.reflectivity > harmless; }))
      return;
    const Exchange exchange(elements_, layout, scan, fineness_.lines, {{0.0, 1, 0, 1.0}},
                            Exitance(elements_.facets.size(), 1));
    std::vector<TriangleLight> light(elements_.elements.size(), TriangleLight{{1.0f, 0.0f}, {}, {}});
    double ratio = 0.0, before = 1.0;
    for (int i = 0; i < 60; ++i) {
      const std::vector<Phasor> values = exchange.bounced(0, light, true);
      light = layout.spread(values);
      float most = 0.0f;
      for (const Phasor &value : values)
        most = std::max(most, abs(value));
      ratio = static_cast<double>(most) / before;
      before = static_cast<double>(most);
      if (ratio < stays)
        return;
    }
    throw Error(
        ExitCode::input,
        "the light that bounces does not end: expected a scene that lets light out or absorbs some of it, "
        "found surfaces of reflectivity 1 all around (\"bounces\": \"all\")");
  }

  const Scene &scene_;
  const std::vector<Illuminator> &illuminators_;
  Shadows shadows_;
  const std::vector<BounceTone> &tones_;
  const Fineness fineness_;
  Elements elements_;
  std::vector<std::array<PieceLight, 2>> of_facets_; // direct
};

} // namespace

Radiosity solve_radiosity(const Scene &scene, const std::vector<Illuminator> &illuminators, Shadows shadows,
                          const Bounces &bounces, const std::vector<BounceTone> &tones,
                          const Fineness &fineness) {
  return Solver(scene, illuminators, shadows, tones, fineness).solve(bounces);
}

} // namespace pmdsim
