#include "engine/multipath/gather.h"

#include "engine/radiosity/line_tilt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pmdsim {

// What the elements in sight are off by: each as it is found to be at its centre, all of it alike, and
// independent of others.
class ElementErrors {
public:
  void resize(std::size_t elements) { off_.resize(elements); }

  void add(std::uint32_t element, float off) {
    if (off_[element] == 0.0f)
      touched_.push_back(element);
    off_[element] += off;
  }
  // And starts again.
  float variance() {
    // The mean of three places is off by a third of the variance of one; their difference from a fourth,
    // which is what is known, has four thirds of it.
    constexpr float variance_of_centre = 0.25f;
    float sum = 0.0f;
    for (const std::uint32_t element : touched_) {
      const float off = std::exchange(off_[element], 0.0f);
      sum += off * off;
    }
    touched_.clear();
    return variance_of_centre * sum;
  }

private:
  std::vector<float> off_; // 0 but for those touched
  std::vector<std::uint32_t> touched_;
};

namespace {

constexpr std::uint32_t first_lines = 16, most_lines = 256;
// How far the sum over lines is off is told by second differences from line to line: what is smooth is summed
// almost without an error, and what jumps or bends shows in them. Measured over places of boxes, rooms and
// meshes the variance is 1/80 to 1/200 of their squares' sum, and falls with the cube of the number of lines.
constexpr float variance_of_differences = 1.0f / 80.0f;

// Radiosity::off takes facets to be off by chance. Beside frames with finer elements it is half of what is
// found.
constexpr float by_more_than_chance = 2.0f;

// How many times the variance is that aimed at, of the tone where that is most.
float excess_of(const std::vector<Gathered> &sums, const GatherAim &aim) {
  float excess = 0.0f;
  for (std::size_t t = 0; t < sums.size(); ++t) {
    const float aimed = aim.part[t] * aim.part[t] * norm(aim.direct[t] + sums[t].irradiance);
    excess = std::max(excess, sums[t].of_lines / std::max(aimed, std::numeric_limits<float>::min()));
  }
  return excess;
}

// The lines' own sums, one after the other, to the squares of their second differences.
class Differences {
public:
  void add(const Phasor &line) {
    if (++lines_ > 2)
      sum_ += norm(before_ + line - 2.0f * last_);
    before_ = last_;
    last_ = line;
  }
  float variance() const { return variance_of_differences * sum_; }

private:
  Phasor before_, last_;
  std::uint32_t lines_ = 0;
  float sum_ = 0.0f;
};

} // namespace

Gather::Gather(const Radiosity &radiosity, const std::vector<BounceTone> &tones) : radiosity_(radiosity) {
  for (const BounceTone &tone : tones)
    turns_per_m_.push_back(tone.turns_per_m());
  for (const Facet &facet : radiosity.elements.facets)
    for (const std::uint32_t element : facet.elements)
      element_of_face_.push_back(element);
  element_of_face_.push_back(no_element);
}

Gather::Lines Gather::at(const SurfacePlace &place, double turn, std::uint32_t guess, const GatherAim &aim,
                         std::vector<Gathered> &gathered) const {
  constexpr float let_through = 1.2f; // of a variance
  Lines lines{std::clamp(guess, first_lines, most_lines), 0};
  const auto look_along = [&](std::uint32_t count) {
    look(place, turn, count, gathered);
    const float excess = excess_of(gathered, aim), wanted = static_cast<float>(count) * std::cbrt(excess);
    lines.needed = static_cast<std::uint32_t>(
        std::clamp(std::ceil(wanted), static_cast<float>(first_lines), static_cast<float>(most_lines)));
    return excess <= let_through;
  };
  const auto first = static_cast<std::uint32_t>(lines.looked);
  if (!look_along(first) && lines.needed > first) {
    lines.looked += lines.needed;
    look_along(lines.needed);
  }
  return lines;
}

float Gather::times_off(const SurfacePlace &place, double turn, const std::vector<Phasor> &direct,
                        const std::vector<float> &part) const {
  std::vector<Gathered> sums;
  look(place, turn, first_lines, sums);
  float most = 0.0f;
  for (std::size_t t = 0; t < sums.size(); ++t) {
    const float all = part[t] * pmdsim::abs(direct[t] + sums[t].irradiance);
    most = std::max(most,
                    std::sqrt(2.0f * sums[t].of_elements) / std::max(all, std::numeric_limits<float>::min()));
  }
  return most;
}

void Gather::look(const SurfacePlace &place, double turn, std::uint32_t lines,
                  std::vector<Gathered> &sums) const {
  thread_local std::vector<Differences> differences;
  thread_local std::vector<ElementErrors> missed;
  const std::size_t tones = turns_per_m_.size();
  missed.resize(tones);
  for (ElementErrors &of_tone : missed)
    of_tone.resize(radiosity_.elements.elements.size());
  differences.assign(tones, {});
  sums.resize(tones);
  for (Gathered &sum : sums) {
    sum.irradiance = {};
    sum.by_tilt = {};
  }
  const LineLightLoops &loops = line_light_loops();
  const SurfaceFrame frame = radiosity_.scan->frame(place, turn, lines);
  const std::array<glm::dvec3, 3> world{glm::dvec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::uint32_t step = std::max(lines / first_lines, 1u); // of lines that tell what elements are off by
  std::uint32_t number = 0;
  radiosity_.scan->at(frame, lines, [&](const SeenLine &line) {
    std::array<LineTilt, 3> by_tilt;
    for (std::size_t k = 0; k < 3; ++k)
      by_tilt[k] = tilt_towards(world[k], frame, line);
    LineWays ways;
    for (std::size_t t = 0; t < tones; ++t) {
      const Exitance::OfFaces &faces = radiosity_.exitance.of_tone(t);
      loops.find_ways(line, turns_per_m_[t], ways);
      const LineLight light = loops.add_light(line, ways, faces.data());
      differences[t].add(light.arrives);
      sums[t].irradiance += light.arrives;
      for (std::size_t k = 0; k < 3; ++k)
        sums[t].by_tilt[k] += by_tilt[k].of(light);
      if (number % step == step / 2)
        add_missed(line, static_cast<float>(step), faces, missed[t]);
    }
    ++number;
  });
  for (std::size_t t = 0; t < tones; ++t) {
    sums[t].of_lines = differences[t].variance();
    const float of_all = by_more_than_chance * radiosity_.off[t];
    sums[t].of_elements = missed[t].variance() + of_all * of_all * norm(sums[t].irradiance);
  }
}

void Gather::add_missed(const SeenLine &line, float lines, const Exitance::OfFaces &faces,
                        ElementErrors &missed) const {
  const std::size_t bins = line.bins->count;
  for (std::size_t i = 0; i < bins; ++i) {
    const auto face = static_cast<std::size_t>(line.face[i]);
    float share = line.share[i];
    for (; i + 1 < bins && line.face[i + 1] == line.face[i]; ++i)
      share += line.share[i + 1];
    if (const std::uint32_t element = element_of_face_[face]; element != no_element)
      missed.add(element, lines * share * faces[face].missed);
  }
}

} // namespace pmdsim
