#pragma once
// The sums over a run's sources as a field, interpolated in cells of the view (engine/view/field_grid.h),
// for samples that all sources reach and that face all of them.
//
// With L a source's place from the run's reference point and lengths in units of rho, a sum over W has the
// factor height + n . L of each source, n the normal of the sample's surface and height the reference point's
// over it. So it follows from four sums that know no surface: of the terms, and of the terms times L. Those
// are smooth in the place, the more so over the beam that they have in common (FieldBeam), and stand at the
// nodes of each cell that samples lie in.
#include "engine/light/host/point_view.h"
#include "engine/light/host/vector_sum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

constexpr std::uint32_t field_components = 4; // the terms, and times L's x, y and z in the camera's frame, m

// The sums of a vector's places.
struct FieldSums {
  Floats of[field_components][most_host_sums] = {};
};

// In the batch's frame: the terms, and times the source's x and y there.
template <std::size_t sums, class Law, class By>
void add_terms(const SourceBatch &batch, const BatchView &at, const Law &law, const By &by,
               Floats (&total)[3][most_host_sums]) {
  for (std::uint32_t first = 0; first < batch.count; first += shader::diodes_per_block) {
    Floats part[3][sums] = {};
    const std::uint32_t last = std::min(batch.count, first + shader::diodes_per_block);
    for (std::uint32_t i = first; i < last; ++i) {
      const BatchSource source = batch.sources[i];
      auto [term, factor] = by(source.intensity * law(at.x_m - source.x_m, at.y_m - source.y_m),
                               at.inverse2_m2 * source.square_m2 + at.twice_x * source.x_m +
                                   at.twice_y * source.y_m + at.detour);
      for (std::size_t k = 0; k < sums; ++k, term *= factor) {
        part[0][k] += term;
        part[1][k] = multiply_add(term, all(source.x_m), part[1][k]);
        part[2][k] = multiply_add(term, all(source.y_m), part[2][k]);
      }
    }
    for (int c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < sums; ++k)
        total[c][k] += part[c][k];
  }
}

template <std::size_t sums, class By>
void add_terms(const SourceBatch &batch, const BatchView &at, const By &by,
               Floats (&total)[3][most_host_sums]) {
  const auto add = [&](const auto &law) { add_terms<sums>(batch, at, law, by, total); };
  if (batch.table)
    return add_by_table(*batch.table, batch, at, add);
  if (!batch.of_lengths && (batch.power.whole != 0 || batch.power.rest != 0.0f))
    return batch.is_multiplied
               ? add(WholePower(batch.power.whole, at.along_m))
               : add(RealPower(static_cast<float>(batch.power.whole) + batch.power.rest, at.along_m));
  add(SharedByAll());
  const Floats shared =
      whole_power(at.along, batch.power.whole) * fraction_of_power(at.along, batch.power.rest);
  for (auto &component : total)
    for (std::size_t k = 0; k < sums; ++k)
      component[k] *= shared;
}

template <class By>
void add_batch(const SourceBatch &batch, const BatchView &at, std::uint32_t sums, const By &by,
               FieldSums &field) {
  Floats own[3][most_host_sums] = {};
  sums <= 4   ? add_terms<4>(batch, at, by, own)
  : sums <= 6 ? add_terms<6>(batch, at, by, own)
  : sums <= 8 ? add_terms<8>(batch, at, by, own)
              : add_terms<most_host_sums>(batch, at, by, own);
  for (std::uint32_t k = 0; k < sums; ++k) {
    field.of[0][k] += own[0][k];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto part = [&](int row) { return static_cast<float>(batch.rotation[row][axis]); };
      field.of[1 + axis][k] += own[1][k] * part(0) + own[2][k] * part(1) +
                               own[0][k] * static_cast<float>(batch.along_m * batch.rotation[2][axis]);
    }
  }
}

// The moments of a run at a vector's places, in units of rho, behind them the first sum, as VectorSum has
// them; and what rounding grows by.
inline FieldSums field_at(const LawSums &of, const RunOfBatches &run, const VectorSamples &at,
                          Floats &growth) {
  const RunView view = view_from(at, run);
  const Floats u = run.table_count > 0 ? largest_u(at, run, view) : all(0.0f);
  const Ints table = tables_of(run, u);
  growth = growth_of(run, table, u);
  const auto add = [&](std::uint32_t sums, const auto &by) {
    FieldSums total;
    for (std::uint32_t i = 0; i < run.count; ++i)
      add_batch(run.batches[i], view_from(at, view, run.batches[i]), sums, by, total);
    return total;
  };
  FieldSums field;
  for (std::uint32_t t = 0; t < run.table_count; ++t) {
    const Ints takes = table == static_cast<std::int32_t>(t);
    if (bits_of(takes) == 0)
      continue;
    const FieldSums sums = add(run.tables[t].powers, ByPowers());
    for (std::size_t c = 0; c < field_components; ++c)
      find_moments(run.tables[t], takes, of.moments, sums.of[c], field.of[c]);
  }
  const Ints beyond = table == static_cast<std::int32_t>(run.table_count);
  if (bits_of(beyond) == 0)
    return field;
  const FieldSums sums = add(of.moments, ByRoots{run.inverse_powers});
  for (std::size_t c = 0; c < field_components; ++c)
    for (std::uint32_t k = 0; k <= of.moments; ++k)
      field.of[c][k] = beyond != 0 ? sums.of[c][k < of.moments ? k : 0] : field.of[c][k];
  return field;
}

// Lagrange's polynomials of the nodes.
class NodeWeights {
public:
  NodeWeights() {
    for (std::size_t i = 0; i < field_nodes; ++i) {
      double apart = 1.0;
      for (std::size_t k = 0; k < field_nodes; ++k)
        apart *= k == i ? 1.0 : field_node_places[i] - field_node_places[k];
      inverse_of_apart_[i] = static_cast<float>(1.0 / apart);
    }
  }

  // At t in [-1, 1].
  void find(const Floats &t, Floats (&weights)[field_nodes]) const {
    for (std::size_t i = 0; i < field_nodes; ++i) {
      weights[i] = all(inverse_of_apart_[i]);
      for (std::size_t k = 0; k < field_nodes; ++k)
        if (k != i)
          weights[i] *= t - static_cast<float>(field_node_places[k]);
    }
  }

private:
  float inverse_of_apart_[field_nodes]; // 1 over the product of a node's distances from the others
};

class IncidentField {
public:
  explicit IncidentField(const LawSums &of)
      : of_(of), side_(of.field->side), values_((of.lambert ? field_components : 1u) * (of.moments + 1)) {}

  // The samples that follow are of this column and row of cells.
  void go_to(std::uint32_t column, std::uint32_t row) {
    column_ = column;
    row_ = row;
    used_ = 0;
  }

  // For the lanes of `takes`, all in one row of samples: the moments of a run, m^-2 m^k, behind them the
  // weights' sum, and what rounding grows by.
  void find(std::uint32_t run, const VectorSamples &samples, const PointView &view, const Ints &takes,
            Floats *moment, Floats &growth) {
    const std::uint32_t columns = of_.samples.strip.columns;
    const auto number = static_cast<std::uint32_t>(samples.number[0]);
    const std::uint32_t row = of_.samples.strip.row + number / columns;
    std::int32_t number_deep[lanes];
    alignas(vector_bytes) float x[lanes], s[lanes];
    for (int lane = 0; lane < lanes; ++lane) {
      const std::uint32_t column =
          of_.samples.strip.column + static_cast<std::uint32_t>(samples.number[lane]) % columns;
      x[lane] = within_cell(column);
      constexpr double most = 1e9; // what is as near takes no field
      const double at =
          std::min(most, of_.field->cells_m * (1.0 / samples.point_m[2][lane] - 1.0 / of_.field->farthest_m));
      number_deep[lane] = static_cast<std::int32_t>(at);
      s[lane] = static_cast<float>(2.0 * (at - number_deep[lane]) - 1.0);
    }
    lagrange_.find(load<Floats>(x), weights_x_);
    lagrange_.find(load<Floats>(s), weights_s_);
    find_beam(run, samples);
    Ints left = takes;
    for (std::uint32_t bits = bits_of(left); bits != 0; bits = bits_of(left)) {
      const std::int32_t first = number_deep[__builtin_ctz(bits)];
      const Ints here = left & (load<Ints>(number_deep) == first);
      left &= ~here;
      Cell &cell = cell_of(run, first);
      go_to_row(cell, row);
      interpolate(cell, view, here, moment);
      growth = here != 0 ? all(cell.growth) : growth;
    }
  }

private:
  static constexpr int nodes = field_nodes * field_nodes * field_nodes;
  static_assert(nodes % lanes == 0);

  // The values of a node are the sums of its components, one component after the other.
  struct Cell {
    std::uint32_t run;
    std::int32_t number_deep;            // in depth
    std::uint32_t row;                   // of samples, that `of_row` is for
    float growth;                        // of rounding, at most
    std::vector<float> of_nodes, of_row; // [row][depth][column][value], [depth][column][value]
  };

  float within_cell(std::uint32_t sample) const {
    return static_cast<float>(2 * (sample % side_) + 1) / static_cast<float>(side_) - 1.0f;
  }

  Cell &cell_of(std::uint32_t run, std::int32_t number_deep) {
    for (std::size_t i = 0; i < used_; ++i)
      if (cells_[i].run == run && cells_[i].number_deep == number_deep)
        return cells_[i];
    if (used_ == cells_.size())
      cells_.emplace_back();
    Cell &cell = cells_[used_++];
    cell.run = run;
    cell.number_deep = number_deep;
    cell.row = none;
    fill(cell);
    return cell;
  }

  // Of the angle between the axis of a run's beam and the way from its reference point to a place.
  double cosine_at(std::uint32_t run, const VectorSamples &at, int lane) const {
    double along_m = 0.0, square_m2 = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double away_m = at.point_m[k][lane] - of_.runs[run].reference_m[k];
      along_m += of_.beams[run].axis[k] * away_m;
      square_m2 += away_m * away_m;
    }
    return along_m / std::sqrt(square_m2);
  }

  bool has_beam(std::uint32_t run) const {
    const Exponent &power = of_.beams[run].power;
    return power.whole > 0 || power.rest > 0.0f;
  }

  void find_beam(std::uint32_t run, const VectorSamples &samples) {
    beam_ = all(1.0f);
    if (!has_beam(run))
      return;
    alignas(vector_bytes) float cosine[lanes];
    for (int lane = 0; lane < lanes; ++lane)
      cosine[lane] = static_cast<float>(cosine_at(run, samples, lane));
    const Exponent &power = of_.beams[run].power;
    const Floats of_axis = load<Floats>(cosine);
    beam_ = whole_power(of_axis, power.whole) * fraction_of_power(of_axis, power.rest);
  }

  // In double, as what nodes are off by differs from node to node.
  double inverse_beam_at(std::uint32_t run, const VectorSamples &nodes_at, int lane) const {
    const Exponent &power = of_.beams[run].power;
    return has_beam(run) ? std::pow(cosine_at(run, nodes_at, lane),
                                    -static_cast<double>(power.whole) - static_cast<double>(power.rest))
                         : 1.0;
  }

  void fill(Cell &cell) {
    cell.of_nodes.resize(std::size_t{nodes} * values_);
    cell.of_row.resize(cell.of_nodes.size() / field_nodes);
    cell.growth = 1.0f;
    for (int first = 0; first < nodes; first += lanes) {
      VectorSamples at{};
      find_nodes(cell.number_deep, static_cast<std::size_t>(first), at);
      Floats growth;
      const FieldSums sums = field_at(of_, of_.runs[cell.run], at, growth);
      cell.growth = std::max(cell.growth, most_of(growth));
      for (int lane = 0; lane < lanes; ++lane) {
        const auto scale = static_cast<float>(inverse_beam_at(cell.run, at, lane));
        for (std::uint32_t value = 0; value < values_; ++value)
          cell.of_nodes[static_cast<std::size_t>(first + lane) * values_ + value] =
              scale * sums.of[value / (of_.moments + 1)][value % (of_.moments + 1)][lane];
      }
    }
  }

  // The points of a vector of nodes.
  void find_nodes(std::int32_t number_deep, std::size_t first, VectorSamples &at) const {
    const shader::Strip &strip = of_.samples.strip;
    double column[lanes], row[lanes], depth_m[lanes];
    const auto place = [&](std::uint32_t cell, std::size_t node, std::uint32_t extent) {
      return side_ * (2.0 * cell + 1.0 + field_node_places[node % field_nodes]) - extent;
    };
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t node = first + lane;
      column[lane] = place(column_, node, strip.resolution_x);
      row[lane] = place(row_, node / field_nodes / field_nodes, strip.resolution_y);
      const double deep = number_deep + 0.5 * (1.0 + field_node_places[node / field_nodes % field_nodes]);
      depth_m[lane] = 1.0 / (1.0 / of_.field->farthest_m + deep / of_.field->cells_m);
    }
    find_points(of_.samples, column, row, depth_m, at.point_m);
  }

  void go_to_row(Cell &cell, std::uint32_t row) const {
    if (cell.row == row)
      return;
    cell.row = row;
    Floats weights[field_nodes];
    lagrange_.find(all(within_cell(row)), weights);
    const std::size_t count = cell.of_row.size();
    for (std::size_t i = 0; i < count; ++i) {
      float sum = 0.0f;
      for (std::size_t k = 0; k < field_nodes; ++k)
        sum += weights[k][0] * cell.of_nodes[k * count + i];
      cell.of_row[i] = sum;
    }
  }

  // A value of the cell's nodes at each sample.
  Floats between(const Cell &cell, std::size_t value) const {
    Floats total = all(0.0f);
    const float *from = cell.of_row.data() + value;
    for (std::size_t k = 0; k < field_nodes; ++k) {
      Floats of_depth = all(0.0f);
      for (std::size_t i = 0; i < field_nodes; ++i, from += values_)
        of_depth = multiply_add(weights_x_[i], all(*from), of_depth);
      total = multiply_add(weights_s_[k], of_depth, total);
    }
    return total;
  }

  void interpolate(const Cell &cell, const PointView &view, const Ints &here, Floats *moment) const {
    const std::uint32_t sums = of_.moments + 1;
    const Floats inverse = 1.0f / view.rho, inverse2 = beam_ * inverse * inverse;
    Floats scale = inverse2;
    for (std::uint32_t k = 0; k < sums; ++k, scale *= view.rho) {
      Floats sum = between(cell, k);
      if (of_.lambert) {
        sum *= view.height;
        for (std::uint32_t axis = 0; axis < 3; ++axis)
          sum += view.normal[axis] * between(cell, (1 + axis) * sums + k);
        sum *= inverse;
      }
      moment[k] = here != 0 ? sum * (k < of_.moments ? scale : inverse2) : moment[k];
    }
  }

  static constexpr std::uint32_t none = ~0u;

  const LawSums &of_;
  const std::uint32_t side_, values_;
  const NodeWeights lagrange_;
  std::uint32_t column_ = 0, row_ = 0; // of cells
  Floats weights_x_[field_nodes], weights_s_[field_nodes];
  Floats beam_;
  std::vector<Cell> cells_; // the first `used_` of them
  std::size_t used_ = 0;
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
