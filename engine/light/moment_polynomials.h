#pragma once
// Moments without roots: over all that is visible the weights and the path differences of a group's diodes
// are smooth functions of u = q / rho^2, q = r_nm^2 - rho^2 = |I|^2 - 2 P.I, so that polynomials in u stand
// for them. The loop over the diodes sums powers of q, and the moments follow from these sums once a sample.
//
// With p the powers of 1 / r_nm in a weight w = W r_nm^-p and e = r_nm - rho,
//   sum w e^k = rho^(k - p) sum_i a_ki S_i / rho^(2 i),   S_i = sum W q^i,
// a_ki the coefficients of the polynomial that interpolates (1 + u)^(-p/2) (sqrt(1 + u) - 1)^k at Chebyshev's
// points.

#include "engine/light/path_difference.h"
#include "shaders/shared/interface.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

struct MomentPolynomials {
  // LightRun::moments_of_powers.
  using Table = std::array<glm::vec4, std::size_t{shader::largest_moments} * shader::largest_powers / 4>;

  std::uint32_t powers = 0;  // S_0 ... S_(powers - 1) are summed; 0: e and its powers, as they are
  std::vector<Table> tables; // beside the runs
  bool coplanar = false;     // the diodes of each run lie in its reference point's plane across the view
  // Where no shadow falls, the diodes' weights differ by their distances only; those that pad a run have
  // none.
  bool equal_weights = false;
  // The number of coordinates in which sums over the diodes of any run are polynomials of the point
  // (point_polynomials.h); 0 where the loop over the diodes is shorter.
  std::uint32_t point_dimensions = 0;
  // The largest errors of any run's polynomials: of the weights' sum, over itself, and as an angle at the
  // highest frequency.
  double weight_error = 0.0, angle_error_rad = 0.0;
  // Likewise, for the moments' sums over i with all terms taken as positive: the sum for the weights, over
  // the weights (a sample's own is growth_at in shaders/light/moments.glsl); and the angle that those for e,
  // e^2, ... turn the return by, over kappa and the sum for the weights, m.
  double growth = 1.0, path_terms_m = 0.0;
};

// `reaches` are the runs'; `moments`, wavenumber_rad_m and `tolerance` as in SourceGroups, `least_intensity`
// that of a diode that shines, relative. No powers where the polynomials would be longer than is worth it, or
// where W could leave float's range.
MomentPolynomials fit_polynomials(std::span<const PathDifference> reaches, double inverse_powers,
                                  std::uint32_t moments, double wavenumber_rad_m, double least_intensity,
                                  double tolerance = 0.0);

// Polynomials of so many powers for places where |u| is at most `largest_u`: the widest whose errors are at
// most those below, and a quarter of what fit_polynomials allows, whose arguments these are, and whose growth
// is at most `largest_growth`.
inline constexpr double largest_near_growth = 2.0; // roots are not much slower, and more exact
struct NearPolynomials {
  double largest_u;
  MomentPolynomials::Table table;
};
// The numbers of powers that such tables have, the fewest first, beside a frame's polynomials of `of_frame`
// powers; 0: it has none.
std::vector<std::uint32_t> near_powers(std::uint32_t of_frame);
double near_weight_error(double tolerance);
double near_angle_error_rad(double tolerance);
std::optional<NearPolynomials> fit_near_polynomials(const PathDifference &reach, double inverse_powers,
                                                    std::uint32_t moments, double wavenumber_rad_m,
                                                    std::uint32_t powers, double tolerance,
                                                    double largest_growth = largest_near_growth);

// The errors and the growth of all of these tables where a frame has no polynomials, and nearer places draw
// roots; it has no tables. Nothing where there are none, either.
std::optional<MomentPolynomials> bound_near_polynomials(std::span<const PathDifference> reaches,
                                                        double inverse_powers, std::uint32_t moments,
                                                        double wavenumber_rad_m, double tolerance,
                                                        double largest_growth = largest_near_growth);

} // namespace pmdsim
