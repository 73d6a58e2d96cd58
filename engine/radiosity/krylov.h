#pragma once
// The solution of x = b + A x, the product with A being given: GMRES without restarts (Y. Saad and M. H.
// Schultz, "GMRES: a generalized minimal residual algorithm", SIAM J. Sci. Stat. Comput. 7, 1986).

#include "engine/radiosity/phasor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace pmdsim {

struct KrylovSolution {
  std::vector<Phasor> x;
  std::uint32_t products = 0;
  double residual = 0.0; // relative to b
};

// Until the residual is `residual` of b's size, or after so many products.
KrylovSolution solve_series(const std::vector<Phasor> &b,
                            const std::function<std::vector<Phasor>(const std::vector<Phasor> &)> &product,
                            double residual, std::uint32_t most_products);

} // namespace pmdsim
