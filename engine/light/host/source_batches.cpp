#include "engine/light/host/source_batches.h"

#include "engine/light/radiation_laws.h"
#include "engine/light/source_windows.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace pmdsim {
namespace {

constexpr float most_cells = 0x1p20f; // of a table
// How much the distances of a batch's sources along its axis may differ, over their distance from the
// reference point: the rounding of such a distance to float.
constexpr double same_distance = 0x1p-24;

bool has_diagram(const shader::GroupSource &source) { return law_of(source).kind == Pattern::Kind::diagram; }

Exponent power_of(const shader::GroupSource &source) {
  return exponent_of(static_cast<double>(std::max(source.order, 0.0f)));
}

bool differs_about_axis(const shader::GroupSource &source) {
  return has_diagram(source) && source.row_length > 0;
}

template <class Table>
void fill_axial(const shader::GroupSource &source, const std::vector<glm::vec2> &diagrams, Table &to) {
  const auto steps = static_cast<std::size_t>(source.theta_steps);
  constexpr auto margin = static_cast<std::size_t>(table_margin);
  to.values.assign(steps + 2 * margin, 0.0f);
  to.rises.assign(steps + 2 * margin, 0.0f);
  for (std::size_t i = 0; i < steps; ++i) {
    const glm::vec2 pair = diagrams[source.diagram + i];
    to.values[margin + i] = pair.x;
    to.rises[margin + i] = pair.y - pair.x;
  }
  to.table.values = to.values.data() + margin;
  to.table.rises = to.rises.data() + margin;
}

// As `diagram` in shaders/light/radiation_laws.glsl has it, at a corner of the even grids' cells.
float corner(const shader::GroupSource &source, const std::vector<glm::vec2> &diagrams, std::size_t theta,
             std::size_t phi) {
  const std::size_t of_phi = source.diagram + static_cast<std::size_t>(source.theta_steps) + 1,
                    rows = of_phi + static_cast<std::size_t>(source.across.w) + 1;
  const float column = diagrams[source.diagram + theta].x, row = diagrams[of_phi + phi].x;
  const auto at = [&](float row_number) {
    const glm::vec2 pair = diagrams[rows + static_cast<std::size_t>(row_number) * source.row_length +
                                    static_cast<std::size_t>(column)];
    return std::lerp(pair.x, pair.y, column - std::floor(column));
  };
  return std::lerp(at(std::floor(row)), at(std::floor(row) + 1.0f), row - std::floor(row));
}

template <class Table>
void fill_cells(const shader::GroupSource &source, const std::vector<glm::vec2> &diagrams, Table &to) {
  const auto thetas = static_cast<std::size_t>(source.theta_steps) + 1,
             phis = static_cast<std::size_t>(source.across.w) + 1;
  for (std::size_t phi = 0; phi < phis; ++phi)
    for (std::size_t theta = 0; theta < thetas; ++theta) {
      const std::size_t next_theta = std::min(theta + 1, thetas - 1), next_phi = std::min(phi + 1, phis - 1);
      const float j = corner(source, diagrams, theta, phi),
                  along = corner(source, diagrams, next_theta, phi) - j,
                  around = corner(source, diagrams, theta, next_phi) - j,
                  both = corner(source, diagrams, next_theta, next_phi) - j - along - around;
      to.cells.insert(to.cells.end(), {j, along, around, both});
    }
  to.table.cells = to.cells.data();
  to.table.phi_steps = static_cast<std::int32_t>(source.across.w);
}

template <class Table>
void fill(const shader::GroupSource &source, const std::vector<glm::vec2> &diagrams, Table &to) {
  to.table.steps = static_cast<std::int32_t>(source.theta_steps);
  to.table.steps_per_rad = source.theta_steps_per_rad;
  to.table.first_step = source.first_theta * source.theta_steps_per_rad;
  if (source.row_length == 0)
    fill_axial(source, diagrams, to);
  else
    fill_cells(source, diagrams, to);
}

// Columns; the last one is the axis.
glm::dmat3 frame_of(const shader::GroupSource &source) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(source.axis));
  glm::dvec3 across(source.across);
  if (!differs_about_axis(source))
    across = std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  across = glm::normalize(across - glm::dot(across, axis) * axis);
  return {across, glm::cross(axis, across), axis};
}

// Whether two sources may share a batch that are `apart_m` apart along their axes, and `distance_m` from the
// reference point at most.
bool are_alike(const shader::GroupSource &a, const shader::GroupSource &b, double apart_m,
               double distance_m) {
  return a.order == b.order && a.diagram == b.diagram && glm::vec3(a.axis) == glm::vec3(b.axis) &&
         (!differs_about_axis(a) || a.across == b.across) && std::abs(apart_m) <= same_distance * distance_m;
}

// Tables, each for more places than the one before it.
std::vector<PowerTable> tables_of(const SourceGroups &groups, const PathDifference &reach,
                                  double inverse_powers, double wavenumber_rad_m) {
  const std::uint32_t moments = groups.moments;
  std::vector<PowerTable> tables;
  for (const std::uint32_t powers : near_powers(groups.polynomials.powers)) {
    const auto fitted = fit_near_polynomials(reach, inverse_powers, moments, wavenumber_rad_m, powers,
                                             groups.tolerance, groups.near_growth);
    const auto largest_u = static_cast<float>(fitted ? fitted->largest_u : 0.0);
    if (!(largest_u > (tables.empty() ? 0.0f : tables.back().largest_u)))
      continue;
    PowerTable &table = tables.emplace_back(PowerTable{largest_u, powers, {}});
    for (std::uint32_t k = 0; k < moments; ++k)
      for (std::uint32_t i = 0; i < powers; ++i)
        table.of_moments[k][i] =
            fitted->table[shader::largest_powers / 4 * k + i / 4][static_cast<glm::length_t>(i % 4)];
  }
  return tables;
}

} // namespace

bool is_known_to_host(const shader::GroupSource &source) {
  switch (law_of(source).kind) {
  case Pattern::Kind::isotropic:
    return true;
  case Pattern::Kind::cosine:
    return source.order > 0.0f;
  case Pattern::Kind::diagram: {
    const float rows = source.row_length > 0 ? source.across.w + 1.0f : 1.0f;
    return (source.theta_steps + 1.0f) * rows <= most_cells;
  }
  }
  return false;
}

SourceBatches::SourceBatches(const SourceGroups &groups, const SumModel &model, double wavenumber_rad_m,
                             bool with_tables)
    : of_lengths_(model.pattern == shader::pattern_power), inverse_powers_(inverse_powers(model)) {
  const std::uint32_t run_bits = bundles_per_run(groups) * shader::diodes_per_bundle;
  for (const SourceRun &run : groups.runs)
    add_run(groups, run, static_cast<std::uint32_t>(runs_.size()) * run_bits);
  if (with_tables)
    add_tables(groups, wavenumber_rad_m);
}

void SourceBatches::add_tables(const SourceGroups &groups, double wavenumber_rad_m) {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const PathDifference &reach = groups.runs[i].reach;
    if (i == 0 || reach != groups.runs[i - 1].reach)
      power_tables_.push_back(tables_of(groups, reach, inverse_powers_, wavenumber_rad_m));
    runs_[i].tables = power_tables_.back().data();
    runs_[i].table_count = static_cast<std::uint32_t>(power_tables_.back().size());
  }
}

void SourceBatches::add_run(const SourceGroups &groups, const SourceRun &run, std::uint32_t first_bit) {
  std::deque<Batch> &batches = batches_.emplace_back();
  for (std::uint32_t i = 0; i < groups.blocks_per_run * shader::diodes_per_block; ++i) {
    const shader::GroupSource &source = groups.diodes[run.first + i];
    if (source.intensity == 0.0f)
      continue;
    const glm::dvec3 place_m = groups.positions[run.first + i].position_m - run.reference_m;
    const glm::dvec3 in_frame_m = place_m * frame_of(source); // each axis with the place
    const auto batch = std::ranges::find_if(batches, [&](const Batch &of) {
      return are_alike(of.like, source, of.along_m - in_frame_m.z, run.reach.radius_m);
    });
    Batch &to = batch != batches.end() ? *batch : batches.emplace_back(Batch{source, in_frame_m.z, {}, {}});
    to.sources.push_back({static_cast<float>(in_frame_m.x), static_cast<float>(in_frame_m.y),
                          static_cast<float>(glm::dot(place_m, place_m)), source.intensity});
    to.bits.push_back(first_bit + i);
    if (has_diagram(source))
      if (const auto [table, is_new] = tables_.try_emplace(source.diagram); is_new)
        fill(source, groups.diagrams, table->second);
  }
  std::vector<SourceBatch> &views = views_.emplace_back();
  for (const Batch &batch : batches)
    views.push_back(view_of(batch));
  runs_.push_back({{run.reference_m.x, run.reference_m.y, run.reference_m.z},
                   static_cast<float>(run.reach.radius_m),
                   views.data(),
                   static_cast<std::uint32_t>(views.size()),
                   nullptr,
                   0,
                   exponent_of(inverse_powers_)});
}

SourceBatch SourceBatches::view_of(const Batch &batch) const {
  SourceBatch view{};
  if (has_diagram(batch.like))
    view.table = &tables_.at(batch.like.diagram).table;
  else
    view.power = power_of(batch.like);
  view.of_lengths = of_lengths_;
  view.is_multiplied = view.power.rest == 0.0f && view.power.whole <= largest_multiplied_power;
  const glm::dmat3 frame = frame_of(batch.like);
  for (glm::length_t row = 0; row < 3; ++row)
    for (glm::length_t k = 0; k < 3; ++k)
      view.rotation[row][k] = frame[row][k];
  view.along_m = batch.along_m;
  for (const BatchSource &source : batch.sources)
    view.radius_m = std::max(view.radius_m, std::hypot(source.x_m, source.y_m));
  view.sources = batch.sources.data();
  view.bits = batch.bits.data();
  view.count = static_cast<std::uint32_t>(batch.sources.size());
  return view;
}

} // namespace pmdsim
