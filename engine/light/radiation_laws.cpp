#include "engine/light/radiation_laws.h"

#include "engine/light/rounding_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace pmdsim {
namespace {

using Kind = Pattern::Kind;

constexpr double unbounded = std::numeric_limits<double>::infinity();

// Isotropic: J = 1.

LawForm isotropic_form(const Pattern &) { return {shader::pattern_isotropic}; }

// A cosine to a power: J = max(0, cos theta)^n.

// Diodes of one order up to here share a form that takes cosines as lengths. The general form is as exact and
// faster beyond, as near the axis, where narrow beams shine, it knows the sine of the angle.
constexpr double largest_shared_order = 24.0;
constexpr double largest_exponent = 87.0; // of e that float holds

void describe_cosine(const Diode &diode, DiagramTables &, shader::GroupSource &record) {
  record.order = static_cast<float>(diode.pattern.order);
}

LawForm cosine_form(const Pattern &pattern) {
  const double order = pattern.order;
  if (order > 0.0 && order <= largest_shared_order)
    return {shader::pattern_power, order};
  return {shader::pattern_general};
}

// The largest tangent of the angle to the diode's axis over a box; a cone is convex, so it is at a corner.
// Infinite where the box reaches beside or behind the diode.
double largest_tangent(const Diode &diode, const VisibleBox &box) {
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place_m((corner & 1) != 0 ? box.high_m.x : box.low_m.x,
                             (corner & 2) != 0 ? box.high_m.y : box.low_m.y,
                             (corner & 4) != 0 ? box.high_m.z : box.low_m.z);
    const glm::dvec3 way_m = place_m - diode.position_m;
    const double along_m = glm::dot(way_m, diode.axis);
    if (!(along_m > 0.0))
      return unbounded;
    largest = std::max(largest, glm::length(glm::cross(diode.axis, way_m)) / along_m);
  }
  return largest;
}

double cosine_slope(const Diode &diode, const std::vector<VisibleBox> &visible) {
  double tangent = 0.0;
  for (const VisibleBox &box : visible)
    tangent = std::max(tangent, largest_tangent(diode, box));
  if (tangent == unbounded) // also of order 0, which ends as an edge
    return unbounded;
  // d ln cos^n = -n tan, and the second derivative is -n / cos^2.
  const double order = diode.pattern.order;
  return std::max(order * tangent, std::sqrt(order * (1.0 + tangent * tangent)));
}

// The rounding of the sine of the angle to the axis, by the way's cross product with it.
double sine_error_u(double t) { return (1.0 + t) / (1.0 - t) + 6.0; }

constexpr double log_rounding = 14.0, last_rounding = 6.0; // of an exponential, by its exponent; of all else

// cos^n = exp(n / 2 log(1 - sin^2)).
double real_power_rounding_u(double order, double t, double cosine) {
  const double c = std::max(cosine, std::exp(-largest_exponent / std::max(order, 1e-9)));
  const double s2 = std::min(0.5, 1.0 - c * c), r2 = squared_range_error_u(t);
  double log_error = (2.0 * std::sqrt(s2) * sine_error_u(t) + s2 * (r2 + 10.0)) / (1.0 - s2);
  if (c * c < 0.5)
    log_error = std::max(log_error, 2.0 * along_error_u(t) / c + r2 + 9.0);
  const double exponent = -order * std::log(c);
  return 0.5 * order * log_error + log_rounding * exponent + last_rounding;
}

// The host multiplies powers out up to here, where a diode may have its own.
bool is_narrow(float order, const LawRounding &sum) {
  return sum.beams_are_apart && sum.pattern != shader::pattern_power &&
         order > static_cast<float>(largest_multiplied_power);
}

// real_power_rounding_u but for its last roundings, at cosines c from least_cosine on, by x = -ln J = n y, y
// = -ln c: it is at most
//   sine sqrt(2 n x + bend x^2) + per_log x,   (s / c^2)^2 = e^2y (e^2y - 1) <= 2 y + bend y^2,
// as that and s^2 / c^2 = e^2y - 1 are convex in y. With 2 a b <= k a^2 + b^2 / k the square of it is at most
// what stands here; k is the best at x = 4. Beyond that cosine the rims of beams are counted, and with those
// no more than this.
BeamError cosine_beam_rounding(float of_order, const LawRounding &sum) {
  if (!is_narrow(of_order, sum))
    return {};
  const double order = static_cast<double>(of_order), t = sum.radius_over_range;
  const double y = std::max(1e-5, std::min(-std::log(sum.least_cosine), largest_exponent / order));
  const double stretch = std::exp(2.0 * y), sine2 = sine_error_u(t) * sine_error_u(t);
  const double bend = (stretch * (stretch - 1.0) - 2.0 * y) / (y * y);
  const double per_log = log_rounding + 0.5 * (squared_range_error_u(t) + 10.0) * (stretch - 1.0) / y;
  const double k = per_log * std::sqrt(4.0 / (2.0 * order * sine2));
  const double per_log2 = (1.0 + k) * bend * sine2 + (1.0 + 1.0 / k) * per_log * per_log;
  return {std::max((1.0 + k) * 2.0 * order * sine2, 2.0 * per_log2), per_log2, order * y};
}

double cosine_rounding_u(float order, const LawRounding &sum) {
  const double t = sum.radius_over_range;
  const double cosine = along_error_u(t) / sum.least_cosine;
  const double shared =
      static_cast<double>(order) * (cosine + 0.5 * squared_range_error_u(t) + root_u + division_u + 5.0) +
      fraction_error_u(static_cast<double>(order), t, sum.least_cosine);
  const bool is_whole = order == std::floor(order);
  if (sum.pattern == shader::pattern_power && is_whole)
    return shared;
  if (is_narrow(order, sum))
    return last_rounding;
  const double real = real_power_rounding_u(static_cast<double>(order), t, sum.least_cosine);
  // Sums in double take fractions by the other form; beside other laws the host may multiply a power out.
  const bool is_either =
      sum.pattern == shader::pattern_power || order <= static_cast<float>(largest_multiplied_power);
  return is_either ? std::max(real, shared) : real;
}

// The steepness of cos^n is n. For n below 1 it is the most that n cos^(n - 1) comes to down to cos = 10^-3,
// where such a beam ends as a step. A half-space, order 0, has no rim but an edge.
std::optional<BeamEdge> cosine_edge(float order) {
  const auto power = static_cast<double>(order);
  if (power <= 0.0)
    return std::nullopt;
  return BeamEdge{power < 1.0 ? 54.0 : power, std::max(power, 1.0)};
}

// A power's error grows by that of the cosine and, in an exponential, by 14 -ln cos <= 14 / (e cos).
double cosine_edge_rounding_u(float order, const LawRounding &sum) {
  const bool is_multiplied = sum.pattern == shader::pattern_power && order == std::floor(order);
  return along_error_u(sum.radius_over_range) + (is_multiplied ? 0.0 : 14.0 / std::numbers::e);
}

// A measured diagram: J from a table.

// Turned so that phi counts from the diagram's first.
glm::dvec3 first_across(const Diode &diode) {
  const double first_phi_rad = diode.pattern.diagram->phi_rad.front();
  return std::cos(first_phi_rad) * diode.across +
         std::sin(first_phi_rad) * glm::cross(diode.axis, diode.across);
}

void describe_diagram(const Diode &diode, DiagramTables &tables, shader::GroupSource &record) {
  const DiagramGrid grid = tables.grid_of(diode.pattern.diagram);
  record.diagram = grid.first_value;
  record.theta_steps = static_cast<float>(grid.theta_steps);
  record.first_theta = static_cast<float>(grid.first_theta_rad);
  record.theta_steps_per_rad = static_cast<float>(grid.theta_steps_per_rad);
  record.row_length = grid.row_length;
  record.across = glm::vec4(first_across(diode), grid.phi_steps);
}

void describe_diagram_precisely(const Diode &diode, PreciseDiagrams &diagrams,
                                shader::PreciseSource &record) {
  record.diagram = diagrams.first_of(diode.pattern.diagram);
  const glm::dvec3 across = first_across(diode);
  record.across_rest = glm::vec4(across - glm::dvec3(glm::vec3(across)), 0.0f);
}

LawForm diagram_form(const Pattern &pattern) {
  return {pattern.diagram->phi_rad.size() == 1 ? shader::pattern_axial : shader::pattern_any};
}

// The rounding of the interpolation; that of the direction is in the table's error.
double diagram_rounding_u(float, const LawRounding &) { return 6.0; }

double error_of_diagram(const Pattern &pattern, DiagramTables &tables, double radius_over_range) {
  return diagram_error(*pattern.diagram, tables.grid_of(pattern.diagram), radius_over_range);
}

double precise_error_of_diagram(const Pattern &pattern) { return precise_diagram_error(*pattern.diagram); }

double cosine_value(const Diode &diode, const glm::dvec3 &way) {
  const double along = glm::dot(diode.axis, way);
  return along > 0.0 ? std::pow(along / glm::length(way), diode.pattern.order) : 0.0;
}

double diagram_value(const Diode &diode, const glm::dvec3 &way) {
  const double along = glm::dot(diode.axis, way);
  const glm::dvec3 across = way - along * diode.axis;
  const double phi_rad =
      std::atan2(glm::dot(across, glm::cross(diode.axis, diode.across)), glm::dot(across, diode.across));
  return relative_at(*diode.pattern.diagram, std::atan2(glm::length(across), along),
                     phi_rad < 0.0 ? phi_rad + 2.0 * std::numbers::pi : phi_rad);
}

constexpr std::array laws{
    RadiationLaw{.kind = Kind::isotropic,
                 .number = -1.0f,
                 .form = isotropic_form,
                 .form_beside_others = shader::pattern_general,
                 .slope = [](const Diode &, const std::vector<VisibleBox> &) { return 0.0; },
                 .rounding_u = [](float, const LawRounding &) { return 0.0; },
                 .value = [](const Diode &, const glm::dvec3 &) { return 1.0; },
                 .series = [](const Pattern &) { return std::optional(LawSeries{}); }},
    RadiationLaw{.kind = Kind::cosine,
                 .number = 0.0f,
                 .describe = describe_cosine,
                 .form = cosine_form,
                 .form_beside_others = shader::pattern_general,
                 .slope = cosine_slope,
                 .rounding_u = cosine_rounding_u,
                 .beam_rounding = cosine_beam_rounding,
                 .value = cosine_value,
                 .edge = cosine_edge,
                 .beam_edge_rounding_u = cosine_edge_rounding_u,
                 .series = [](const Pattern &cosine) { return std::optional(LawSeries{cosine.order}); }},
    RadiationLaw{.kind = Kind::diagram,
                 .number = -2.0f,
                 .describe = describe_diagram,
                 .describe_precisely = describe_diagram_precisely,
                 .form = diagram_form,
                 .rounding_u = diagram_rounding_u,
                 .error = error_of_diagram,
                 .precise_error = precise_error_of_diagram,
                 .value = diagram_value,
                 .unbounded = "a measured diagram that varies about its own axis has no bound"},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (laws[i].kind != static_cast<Kind>(i))
      return false;
  return laws.size() == law_names.size();
}
static_assert(are_in_order(), "laws[kind] is the law of that kind");

// Calls `use` with what each law's function has for each order among its diodes.
template <class Member, class Use>
void for_each_order(std::span<const shader::GroupSource> diodes, Member member, Use use) {
  std::set<float> orders; // each of one law (RadiationLaw::number)
  for (const shader::GroupSource &diode : diodes)
    if (orders.insert(diode.order).second)
      if (const auto function = law_of(diode).*member)
        use(function, diode.order);
}

} // namespace

const RadiationLaw &law_of(const Pattern &pattern) { return laws[static_cast<std::size_t>(pattern.kind)]; }

const RadiationLaw &law_of(const shader::GroupSource &diode) {
  return *std::ranges::find(laws, std::min(diode.order, 0.0f), &RadiationLaw::number);
}

double law_error(const Pattern &pattern, DiagramTables &tables, double radius_over_range) {
  const RadiationLaw &law = law_of(pattern);
  if (law.rounding_u == nullptr)
    return unbounded;
  return law.error != nullptr ? law.error(pattern, tables, radius_over_range) : 0.0;
}

double precise_law_error(const Pattern &pattern) {
  const RadiationLaw &law = law_of(pattern);
  if (law.rounding_u == nullptr)
    return unbounded;
  return law.precise_error != nullptr ? law.precise_error(pattern) : 0.0;
}

double largest_radiation(const Pattern &pattern) {
  return pattern.diagram ? std::max(1.0, std::ranges::max(pattern.diagram->relative)) : 1.0;
}

std::optional<BeamEdge> beam_edge(const shader::GroupSource &diode) {
  const RadiationLaw &law = law_of(diode);
  return law.edge != nullptr ? law.edge(diode.order) : std::nullopt;
}

std::optional<LawSeries> law_series(const Pattern &pattern) {
  const RadiationLaw &law = law_of(pattern);
  return law.series != nullptr ? law.series(pattern) : std::nullopt;
}

LawForm form_of(const std::vector<CameraIlluminator> &illuminators) {
  std::optional<LawForm> all;
  std::uint32_t beside_others = shader::pattern_isotropic;
  bool alike = true;
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes) {
      const RadiationLaw &law = law_of(diode.pattern);
      const LawForm form = law.form != nullptr ? law.form(diode.pattern) : LawForm{};
      alike = alike && form == all.value_or(form);
      all = form;
      beside_others = std::max(beside_others, law.form_beside_others);
    }
  if (alike)
    return all.value();
  return {beside_others};
}

double pattern_slope(const std::vector<CameraIlluminator> &illuminators,
                     const std::vector<VisibleBox> &visible) {
  double largest = 0.0;
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes)
      if (const auto slope = law_of(diode.pattern).slope; largest < unbounded)
        largest = std::max(largest, slope != nullptr ? slope(diode, visible) : unbounded);
  return largest;
}

double law_rounding_u(std::span<const shader::GroupSource> diodes, const LawRounding &sum) {
  double largest = 0.0;
  for_each_order(diodes, &RadiationLaw::rounding_u,
                 [&](auto rounding_u, float order) { largest = std::max(largest, rounding_u(order, sum)); });
  return largest;
}

double beam_edge_rounding_u(std::span<const shader::GroupSource> diodes, const LawRounding &sum) {
  double largest = 0.0;
  for_each_order(diodes, &RadiationLaw::beam_edge_rounding_u,
                 [&](auto rounding_u, float order) { largest = std::max(largest, rounding_u(order, sum)); });
  return largest;
}

BeamError beam_rounding(std::span<const shader::GroupSource> diodes, const LawRounding &sum) {
  BeamError largest;
  for_each_order(diodes, &RadiationLaw::beam_rounding, [&](auto rounding, float order) {
    const BeamError of_order = rounding(order, sum);
    largest.square = std::max(largest.square, of_order.square);
    largest.square_per_log = std::max(largest.square_per_log, of_order.square_per_log);
    largest.darkest = std::max(largest.darkest, of_order.darkest);
  });
  return largest;
}

} // namespace pmdsim
