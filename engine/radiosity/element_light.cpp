#include "engine/radiosity/element_light.h"

#include <algorithm>

namespace pmdsim {
namespace {

constexpr std::size_t gauss_points = places_of_piece - 1;

glm::vec2 tilt_in(const Element &group, const glm::dvec3 &normal) {
  return {static_cast<float>(glm::dot(normal, group.axes[1])),
          static_cast<float>(glm::dot(normal, group.axes[2]))};
}

TriangleLight at_place(const std::vector<Phasor> &values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

} // namespace

glm::dmat3 triangle_from_corners(const Facet &facet) {
  glm::dmat3 corner_from_triangle; // its columns are rows
  for (glm::length_t k = 0; k < 3; ++k) {
    const CornerWeights &corner = facet.in_triangle[static_cast<std::size_t>(k)];
    corner_from_triangle[k] = {1.0, corner.y, corner.z};
  }
  return glm::transpose(glm::inverse(glm::transpose(corner_from_triangle)));
}

TriangleLight times(const glm::mat3 &rows, const Phasor *values) {
  const auto row = [&](glm::length_t i) {
    return rows[i].x * values[0] + rows[i].y * values[1] + rows[i].z * values[2];
  };
  return {row(0), row(1), row(2)};
}

ElementLight::ElementLight(const Elements &elements)
    : elements_(elements), first_values_{0}, shapes_(elements.elements.size()),
      middles_(elements.elements.size(), glm::vec2(0.0f)) {
  for (std::size_t i = 0; i < elements.elements.size(); ++i)
    first_values_.push_back(first_values_.back() + places_of_piece * values_of_place(i));
  for (const Facet &facet : elements.facets) {
    if (facet.whole)
      continue;
    const glm::dmat3 rows = triangle_from_corners(facet); // any facet of an element tells its shape
    glm::mat3 shape(0.0f);
    for (glm::length_t i = 0; i < 3; ++i)
      for (glm::length_t k = 0; k < 3; ++k)
        shape[i] += static_cast<float>(rows[i][k]) * facet.in_element[static_cast<std::size_t>(k)];
    const CornerWeights middle = mixed(facet.in_triangle, piece_weights[gauss_points]);
    for (const std::uint32_t element : facet.elements)
      if (element != no_element) {
        const double part = facet.area_m2() / elements.elements[element].area_m2;
        shapes_[element] = shape;
        middles_[element] += glm::vec2(part * glm::dvec2(middle.y, middle.z));
      }
  }
}

std::vector<Phasor> ElementLight::without_last_places(std::vector<Phasor> values) const {
  for (std::size_t i = 0; i < shapes_.size(); ++i)
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(first_value(i, gauss_points)),
                values_of_place(i), Phasor{});
  return values;
}

std::vector<TriangleLight> ElementLight::spread(const std::vector<Phasor> &values) const {
  std::vector<TriangleLight> light(shapes_.size());
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (!elements_.elements[i].is_group) {
      light[i] = times(shapes_[i], &values[first_values_[i]]);
      continue;
    }
    for (std::size_t place = 0; place < gauss_points; ++place)
      light[i] += (1.0f / gauss_points) * at_place(values, first_value(i, place));
  }
  return light;
}

std::vector<Phasor> ElementLight::middles(std::span<const TriangleLight> light) const {
  std::vector<Phasor> middles(light.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    middles[i] = light_at(light[i], middles_[i].x, middles_[i].y);
  return middles;
}

Phasor ElementLight::missed(const std::vector<Phasor> &values, std::size_t element) const {
  const Phasor *first = &values[first_values_[element]];
  const Element &of = elements_.elements[element];
  if (!of.is_group)
    return first[3] - (1.0f / gauss_points) * (first[0] + first[1] + first[2]);
  const glm::vec2 tilt = tilt_in(of, of.places[gauss_points].normal);
  Phasor missed = light_at(at_place(values, first_value(element, gauss_points)), tilt.x, tilt.y);
  for (std::size_t place = 0; place < gauss_points; ++place)
    missed +=
        (-1.0f / gauss_points) * light_at(at_place(values, first_value(element, place)), tilt.x, tilt.y);
  return missed;
}

glm::vec2 ElementLight::tilt_of(const Facet &facet, std::size_t side) const {
  return tilt_in(elements_.elements[facet.elements[side]], places_of(facet, side)[0].normal);
}

} // namespace pmdsim
