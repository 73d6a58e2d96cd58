#pragma once
// The light that arrives on elements, as one tone has it: values at their places, and from these a linear
// function for each element. On a piece of a triangle that is one of the place there; on a group of small
// triangles, one of how each is tilted.

#include "engine/radiosity/face_light.h"
#include "engine/surfaces/elements.h"

#include <cstdint>
#include <span>
#include <vector>

namespace pmdsim {

// From a linear function's values at the corners of a facet to it as TriangleLight has it, by rows.
glm::dmat3 triangle_from_corners(const Facet &facet);

// By rows: from values at three places.
TriangleLight times(const glm::mat3 &rows, const Phasor *values);

class ElementLight {
public:
  // A piece has one value a place: what arrives there. A group has three: what would arrive there on a
  // surface along its mean normal, and the change with a tilt towards each of its directions.
  static constexpr std::size_t values_of_group_place = 3;

  // The elements have to outlive this; the facets have to be cut by then.
  explicit ElementLight(const Elements &elements);

  std::size_t values() const { return first_values_.back(); }
  // Of a place: the first of its values, and how many there are.
  std::size_t first_value(std::size_t element, std::size_t place) const {
    return first_values_[element] + place * values_of_place(element);
  }
  std::size_t values_of_place(std::size_t element) const {
    return elements_.elements[element].is_group ? values_of_group_place : 1;
  }

  // With 0 there.
  std::vector<Phasor> without_last_places(std::vector<Phasor> values) const;

  // One function for each element.
  std::vector<TriangleLight> spread(const std::vector<Phasor> &values) const;
  // Of these functions, in the middle of each element.
  std::vector<Phasor> middles(std::span<const TriangleLight> light) const;
  // By how much the last place of an element differs from what is found there by the others.
  Phasor missed(const std::vector<Phasor> &values, std::size_t element) const;

  // How far a face's triangle is tilted, in terms of its element's group: what stands for the weights there.
  glm::vec2 tilt_of(const Facet &facet, std::size_t side) const;

private:
  const Elements &elements_;
  std::vector<std::size_t> first_values_; // of each element, and their number
  std::vector<glm::mat3> shapes_;         // of pieces, by rows: from their Gauss points
  std::vector<glm::vec2> middles_;        // what their functions take there
};

} // namespace pmdsim
