// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimetry/judgement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mmbrdf/polarimetry/reduction.hpp"
#include "mmbrdf/polarization/analysis.hpp"
#include "polarimetry/wafer_signs.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

void judge_condition(Verdict& verdict, const std::string& arm, double condition) {
  if (!verdict.refusal.empty()) return;
  const std::string text = "the condition number of the " + arm + " is " + rounded(condition, 4) + ", more than ";
  if (!(condition <= worst_condition))
    verdict.refusal = text + shortest(worst_condition);
  else if (condition > doubtful_condition)
    verdict.doubts.push_back(text + shortest(doubtful_condition) + ": noise of the readings grows by it");
}

void judge_merit(Verdict& verdict, double merit) {
  if (!verdict.refusal.empty()) return;
  const auto complaint = [&](double limit) {
    return "figure of merit " + rounded(merit, 2) + ", more than " + shortest(limit) +
           ": are states or references mixed up, or angles wrong?";
  };
  if (!(merit <= worst_merit))
    verdict.refusal = complaint(worst_merit);
  else if (merit > doubtful_merit)
    verdict.doubts.push_back(complaint(doubtful_merit));
}

void judge_thickness(Verdict& verdict, double found, double given) {
  if (!verdict.refusal.empty() || !(given > 0)) return;
  const double change = found / given - 1;
  if (std::abs(change) > doubtful_film_change)
    verdict.doubts.push_back("the film is " + fixed(found, 4) + " um thick, " + (change > 0 ? "+" : "") +
                             fixed(100 * change, 0) + " % from the given " + rounded(given, 6) +
                             " um: is it the right one?");
}

/// Readings that are pairs of states: noise grows by the condition number of all of them, and some may be missing.
void judge_pairs(Verdict& verdict, const Calibration& calibration) {
  if (calibration.polarimeter.pairs.empty() || !verdict.refusal.empty()) return;
  const Reduction reduction(calibration.polarimeter);
  const std::string frames = std::to_string(calibration.polarimeter.pairs.size()) + " pairs of states ";
  if (const Elements& unknown = reduction.undetermined(); unknown.any())
    verdict.doubts.push_back("its " + frames + "have rank " + std::to_string(reduction.rank()) + " and leave unknown " +
                             element_names(unknown));
  else if (reduction.condition() > doubtful_condition * doubtful_condition)
    verdict.doubts.push_back("the condition number of its " + frames + "is " + rounded(reduction.condition(), 4) +
                             ", more than " + shortest(doubtful_condition * doubtful_condition) +
                             ": noise of the readings grows by it");
}

/// Ten numbers are all that such an instrument is thought to be.
void judge_misfit(Verdict& verdict, const Calibration& calibration) {
  if (!calibration.retarders || calibration.degrees_of_freedom == 0 || !verdict.refusal.empty()) return;
  const double ratio = calibration.chi_squared / static_cast<double>(calibration.degrees_of_freedom);
  if (ratio > doubtful_misfit)
    verdict.doubts.push_back("chi^2/dof is " + rounded(ratio, 3) + ", more than " + shortest(doubtful_misfit) +
                             ": is the noise of the readings larger than it was said to be, or the instrument not what "
                             "its ten numbers describe: depolarization, background light, another ratio or step?");
}

/// Fast and slow axes of both retarders exchanged explain air as well: the choice was the nearer to the nominal azimuths.
void judge_axes(Verdict& verdict, const Calibration& c, const std::optional<RetarderOptions>& given) {
  if (!c.retarders || !given || !verdict.refusal.empty()) return;
  const bool told = std::any_of(c.references.begin(), c.references.end(), [](const auto& r) {
    return r.kind == ReferenceKind::wafer ||
           (r.kind == ReferenceKind::retarder && std::abs(std::sin(r.element.delta)) > calibration::clear_sign);
  });
  const RotatingRetarders &found = c.retarders->values, &nominal = given->nominal;
  const double off = std::max(std::abs(found.generator.offset - nominal.generator.offset),
                              std::abs(found.analyzer.offset - nominal.analyzer.offset));
  if (!told && off > doubtful_offset)
    verdict.doubts.push_back("a fast axis is " + fixed(degrees(off), 1) +
                             " degrees from its nominal azimuth: air does not tell it from the slow one; measure a "
                             "retarder or a wafer of known sign");
}

}  // namespace

Verdict judged(const Calibration& calibration, const std::optional<Film>& film,
               const std::optional<RetarderOptions>& retarders) {
  Verdict verdict;
  judge_condition(verdict, "generator", calibration.generator_condition);
  judge_condition(verdict, "analyzer", calibration.analyzer_condition);
  judge_merit(verdict, calibration.figure_of_merit.total);
  judge_pairs(verdict, calibration);
  judge_misfit(verdict, calibration);
  judge_axes(verdict, calibration, retarders);
  if (film && !calibration.retarders) judge_thickness(verdict, calibration.film_thickness, film->thickness);
  return verdict;
}

Verdict judged(std::span<const Sample> samples) {
  const auto impossible = std::count_if(samples.begin(), samples.end(), [](const Sample& sample) {
    return not_measured(sample).none() && coherency_eigenvalues(sample.normalized)[0] < impossible_eigenvalue;
  });
  if (impossible == 0) return {};
  return {{std::to_string(impossible) + " of " + std::to_string(samples.size()) +
           " matrices cannot be physical: are generator and analyzer states exchanged, or is it another instrument?"},
          ""};
}

}  // namespace mmbrdf
