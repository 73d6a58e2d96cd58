#include "host/output/tables/diode_tables.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

constexpr std::size_t best = 10; // diodes that are listed

// Three digits, right-aligned by the caller; what is rounding is nothing.
std::string um(double length_m) {
  constexpr double least_um = 5e-4;
  const double length_um = um_per_m * length_m;
  if (std::isnan(length_um))
    return "-";
  if (length_um < least_um)
    return "0";
  const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(length_um))), 0, 3);
  return fmt::format("{:.{}f}", length_um, digits);
}

// With its standard error.
std::string ratio_text(double found, double theory, double standard_error) {
  constexpr double least_m = 1e-10;
  return theory > least_m ? fmt::format("{:.3f} ±{:.3f}", found / theory, standard_error) : "-";
}

std::string error_text(Fault fault, const Tolerances &tolerances) {
  if (fault == Fault::dead)
    return "dead";
  return fmt::format("{} {}", fault_text(fault), tolerance_text(kind_of(fault), tolerances));
}

double middle_of(const DiodeStudy &study, std::size_t fault, double ImageChange::*figure) {
  std::vector<double> values;
  for (const DiodeEffect &effect : study.theory.diodes)
    values.push_back(effect.faults[fault].*figure);
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  return values.empty() ? no_change : values[values.size() / 2];
}

std::size_t worst_of(const DiodeStudy &study, std::size_t fault) {
  const auto rms_m = [&](std::size_t m) {
    const double value_m = study.theory.diodes[m].faults[fault].rms_m;
    return std::isnan(value_m) ? -1.0 : value_m;
  };
  std::size_t worst = 0;
  for (std::size_t m = 1; m < study.diodes.size(); ++m)
    worst = rms_m(m) > rms_m(worst) ? m : worst;
  return worst;
}

std::string which_text(const DiodeStudy &study, std::size_t worst, double worst_m, double typical_m) {
  constexpr double hardly = 1.01;
  if (um(worst_m) == "0" || std::isnan(worst_m))
    return "-";
  return study.diodes.size() > 1 && worst_m < hardly * typical_m ? "all about alike"
                                                                 : diode_name(study.diodes[worst]);
}

std::string one_diode_text(const DiodeStudy &study) {
  std::string text = fmt::format("{:<25}{:>10}{:>10}  {:>10}{:>10}  {}\n", "one diode off by, µm", "typical",
                                 "varying", "worst", "varying", "which");
  for (std::size_t i = 0; i < fault_count; ++i) {
    const std::size_t worst = worst_of(study, i);
    const ImageChange &change = study.theory.diodes[worst].faults[i];
    const double typical_m = middle_of(study, i, &ImageChange::rms_m);
    text += fmt::format("{:<25}{:>10}{:>10}  {:>10}{:>10}  {}\n",
                        error_text(static_cast<Fault>(i), study.tolerances), um(typical_m),
                        um(middle_of(study, i, &ImageChange::varying_rms_m)), um(change.rms_m),
                        um(change.varying_rms_m), which_text(study, worst, change.rms_m, typical_m));
  }
  return text;
}

std::string board_text(const DiodeStudy &study) {
  std::string text = fmt::format("{:<25}{:>10}{:>10}{:>15}{:>15}{:>16}{:>10}\n", "every diode off by, µm",
                                 "theory", "varying", "found/theory", "varying", "95 % of boards", "varying");
  for (std::size_t kind = 0; kind <= kind_count; ++kind) {
    const std::string name = kind == kind_count
                                 ? "all of these"
                                 : fmt::format("{} {}", kind_names[kind],
                                               tolerance_text(static_cast<Kind>(kind), study.tolerances));
    const Deviation &theory = study.theory.board[kind], &here = study.random.theory[kind];
    const BoardStatistics &found = study.random.found[kind];
    text += fmt::format("{:<25}{:>10}{:>10}{:>15}{:>15}{:>16}{:>10}\n", name, um(theory.rms_m),
                        um(theory.varying_rms_m), ratio_text(found.rms_m, here.rms_m, found.standard_error),
                        ratio_text(found.varying_rms_m, here.varying_rms_m, found.varying_standard_error),
                        um(found.most_rms_m), um(found.most_varying_rms_m));
  }
  return text;
}

std::string alike_text(const DiodeStudy &study) {
  constexpr std::size_t most_listed = 4;
  std::string text =
      fmt::format("{:<40}{:>10}{:>10}\n", "all diodes of one illuminator alike, µm", "all", "varying");
  const std::size_t listed = std::min(study.illuminators.size(), most_listed);
  for (std::size_t light = 0; light < listed; ++light)
    for (std::size_t i = 0; i < slope_count; ++i) {
      const ImageChange &change = study.theory.alike[light][i];
      text += fmt::format("{:<40}{:>10}{:>10}\n",
                          fmt::format("{}: {}", study.illuminators[light],
                                      error_text(static_cast<Fault>(i), study.tolerances)),
                          um(change.rms_m), um(change.varying_rms_m));
    }
  if (listed < study.illuminators.size())
    text += fmt::format("... and {} illuminators more in alike.csv\n", study.illuminators.size() - listed);
  return text;
}

std::string ranking_text(const DiodeStudy &study) {
  std::string text = fmt::format("{:<28}{:>9}{:>9}{:>9}  {:>8}{:>11}{:>10}\n", "diodes that matter most, µm",
                                 "x, mm", "y, mm", "z, mm", "light", "in a board", "varying");
  std::vector<std::size_t> order = study.ranking();
  order.resize(std::min(order.size(), best));
  for (const std::size_t m : order) {
    const StudiedDiode &diode = study.diodes[m];
    const DiodeEffect &effect = study.theory.diodes[m];
    text +=
        fmt::format("{:<28}{:>9.2f}{:>9.2f}{:>9.2f}  {:>6.2f} %{:>11}{:>10}\n", diode_name(diode),
                    1e3 * diode.position_m.x, 1e3 * diode.position_m.y, 1e3 * diode.position_m.z,
                    100.0 * effect.light_share, um(effect.in_board.rms_m), um(effect.in_board.varying_rms_m));
  }
  return text;
}

// The kind that makes the most of a board's variance.
struct Dominating {
  std::size_t kind = 0;
  double share = 0.0;
};

Dominating dominating(const BoardDeviation &board, double Deviation::*figure) {
  const auto of = [&](std::size_t kind) { return board[kind].*figure * (board[kind].*figure); };
  Dominating most;
  for (std::size_t kind = 1; kind < kind_count; ++kind)
    most.kind = of(kind) > of(most.kind) ? kind : most.kind;
  most.share = of(kind_count) > 0.0 ? of(most.kind) / of(kind_count) : 0.0;
  return most;
}

std::string dominating_text(const DiodeStudy &study) {
  const Dominating all = dominating(study.theory.board, &Deviation::rms_m),
                   varying = dominating(study.theory.board, &Deviation::varying_rms_m);
  if (all.share == 0.0)
    return "Nothing moves the distance.\n";
  const auto name = [&](const Dominating &of) {
    return fmt::format("{} ({})", kind_names[of.kind],
                       tolerance_text(static_cast<Kind>(of.kind), study.tolerances));
  };
  return fmt::format("The tolerance that dominates is {}: it makes {:.0f} % of the variance of a board's "
                     "distances.\nOf what a calibrated offset leaves, {} makes {:.0f} %.\n",
                     name(all), 100.0 * all.share, name(varying), 100.0 * varying.share);
}

// Where the whole formula says something else than theory.
std::string not_linear_text(const DiodeStudy &study) {
  constexpr double noted = 0.05, sure = 4.0;
  std::vector<std::string> texts;
  for (std::size_t kind = 0; kind < kind_count; ++kind) {
    const double found = study.random.found[kind].rms_m, theory = study.random.theory[kind].rms_m;
    const double off = std::abs(found / theory - 1.0);
    if (um(theory) != "0" && off > std::max(noted, sure * study.random.found[kind].standard_error))
      texts.push_back(fmt::format("{} ({})", kind_names[kind],
                                  tolerance_text(static_cast<Kind>(kind), study.tolerances)));
  }
  return texts.empty()
             ? ""
             : fmt::format("For theory, which is linear, these errors are too large: {}. The random "
                           "boards are right.\n",
                           fmt::join(texts, ", "));
}

std::string no_axis_text(const DiodeStudy &study) {
  const bool matters = study.theory.board[static_cast<std::size_t>(Kind::axis)].rms_m > 0.0;
  return matters || study.tolerances.axis_rad == 0.0
             ? ""
             : "The diodes are isotropic: a tilt of an axis changes nothing.\n";
}

std::string dark_text(const DiodeStudy &study) {
  std::size_t diodes = 0, most = 0;
  for (const DiodeEffect &effect : study.theory.diodes) {
    diodes += effect.left_dark > 0 ? 1 : 0;
    most = std::max(most, effect.left_dark);
  }
  return diodes == 0
             ? ""
             : fmt::format("{} diode{} alone light{} some of the pixels, up to {}: dark without, these "
                           "are left out of what a dead diode does.\n",
                           diodes, diodes == 1 ? "" : "s", diodes == 1 ? "s" : "", most);
}

} // namespace

std::string diode_study_text(const DiodeStudy &study) {
  const bool is_gaussian = study.tolerances.law == ErrorLaw::gaussian;
  const RandomBoards &random = study.random;
  return fmt::format(
      "sensor {} at {:.10g} MHz: {} diodes light {} of {} x {} pixels spread over the image\n\n"
      "{}\n"
      "Figures are root mean squares over the image of the change of distance. `varying` is what is left of "
      "it "
      "when\nits mean over the image, the offset that a calibration removes, is taken away.\n\n"
      "{}\n"
      "Figures are standard deviations over boards whose diodes are all off at random and independently{}.\n"
      "Found: {} boards, seed {}, at {} of the pixels, with standard errors. 95 % of these boards: so much "
      "their "
      "root\nmean square over these pixels does not exceed.\n\n"
      "{}\n{}\n{}{}{}{}",
      study.sensor, 1e-6 * study.modulation_hz, study.diodes.size(), study.theory.lit_points, study.grid.x,
      study.grid.y, one_diode_text(study), board_text(study),
      is_gaussian ? " (Gaussian,\nthe tolerance is the standard deviation)"
                  : " (evenly\nwithin plus and minus the tolerance)",
      random.boards, random.seed, random.points.size(), alike_text(study), ranking_text(study),
      no_axis_text(study), not_linear_text(study), dark_text(study), dominating_text(study));
}

} // namespace pmdsim
