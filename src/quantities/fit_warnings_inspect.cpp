// SPDX-License-Identifier: BSD-3-Clause
// Data before they are fitted.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/conventions.hpp"
#include "mmbrdf/quantities/fit_warnings.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "quantities/angle_unit.hpp"
#include "quantities/cosine.hpp"
#include "quantities/fit_limits.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr long enough_samples = 60;
constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

const char* const scale = "scale of f11";
const char* const cosine = "cosine";
const char* const azimuths = "azimuths";

/// Of the first wavelength, evenly spread.
std::vector<Sample> without_fills(std::span<const Sample> samples) {
  const FillValues fill_values(samples);
  std::vector<Sample> here;
  std::ranges::copy_if(samples, std::back_inserter(here), [&](const Sample& s) {
    return same_wavelength(s.wavelength, samples.front().wavelength) && !fill_values.include(s);
  });
  const std::size_t count = std::min(here.size(), most_tried);
  for (std::size_t i = 0; i < count; ++i) here[i] = here[i * here.size() / count];
  here.resize(count);
  return here;
}

double rms_of_f11(std::span<const Sample> samples) {
  double squares = 0, count = 0;
  for (const Sample& sample : samples)
    if (!std::isnan(sample.f11)) squares += sample.f11 * sample.f11, ++count;
  return count > 0 ? std::sqrt(squares / count) : 0;
}

double relative_rms(std::span<const Sample> samples, const FitResult& fitted) {
  const double all = rms_of_f11(samples);
  return all > 0 ? fitted.elements[0].rms / all : 0;
}

FitResult fit_of_low_order(std::span<const Sample> samples) {
  FitOptions options;
  options.minimum_norm = true;
  return fit(samples, {Family::isotropic, inspected_orders}, options);
}

/// Samples that are looked at, and the fit to them.
struct Looked {
  std::vector<Sample> samples;
  FitResult fitted;
};

/// Of f11, or of the most numerous block of the others.
std::size_t coefficients(const FitResult& fitted, bool f11) {
  std::size_t most = 0;
  for (const FittedBlock& block : fitted.model.blocks)
    if ((block.block.elements.front().index() == 0) == f11) most = std::max(most, block.coefficients.size());
  return most;
}

/// Why these samples are too few; empty if they are not.
std::string too_few(const Looked& at, bool f11) {
  const auto unknowns = static_cast<long>(coefficients(at.fitted, f11));
  const long rows = f11 ? at.fitted.elements[0].rows : static_cast<long>(at.samples.size());
  if (rows >= 2 * unknowns) return "";
  return counted(rows, "sample") + ", and a fit of low order has " + std::to_string(unknowns) + " coefficients";
}

bool is_better(double as_is, double other) { return as_is > better_convention * std::max(other, exact_rms); }

/// Why a fit of low order says little of a reflectance; empty if it says enough.
std::string no_reflectance(const Inspection& seen, const Looked& at) {
  constexpr double most_missing = 0.2, most_left = 0.2;
  const long rows = at.fitted.elements[0].rows;
  if (rows < enough_samples)
    return counted(rows, "sample") + ", of " + std::to_string(enough_samples) + " that it takes to know a reflectance";
  if (seen.unsupported > most_missing)
    return rounded(100 * seen.unsupported, 2) + " % of the pairs of directions are not covered";
  if (seen.f11_residual > most_left)
    return "a fit of low order leaves " + rounded(100 * seen.f11_residual, 2) + " % of f11, noise or a peak";
  return "";
}

/// Of a reflectance of which a fit of low order says little, its standard uncertainty too.
bool is_beyond_doubt(const F11Diagnostics& found) {
  constexpr double doubtful = 2;
  return found.dhr > impossible || (found.dhr > doubtful && found.dhr - 1 > surely * found.u_dhr);
}

void look_at_scale(Inspection& result, const Looked& at) {
  constexpr double least = 30;  // degrees: of less than a quarter of the hemisphere a reflectance is an extrapolation
  const Validity& validity = at.fitted.model.validity;
  const double reached = degrees(validity.theta_r_max.value_or(0));
  if (reached < least) {
    result.untested.push_back(
        {scale, "theta_r up to " + rounded(reached, 3) + " degrees, of " + rounded(least, 2) + " that it takes"});
    return;
  }
  const auto found =
      f11_diagnostics(at.fitted.model, at.samples.front().wavelength, fitted_theta_max(validity), coarser);
  const std::string doubt = no_reflectance(result, at);
  if (const std::string line = energy_line(found, "of a fit of low order");
      !line.empty() && (doubt.empty() || is_beyond_doubt(found)))
    result.findings.push_back({scale, line, "", {}});
  else if (!doubt.empty())
    result.untested.push_back({scale, doubt});
}

/// What a fit leaves of f11 after it is multiplied by cos^power θr.
double left_with_cosine(std::span<const Sample> samples, int power) {
  constexpr double grazing = 0.1;  // cos θr: the division would make noise of it
  std::vector<Sample> scaled;
  for (Sample sample : samples) {
    const double factor = std::cos(sample.geometry.reflected.theta);
    if (factor < grazing || std::isnan(sample.f11)) continue;
    sample.f11 *= std::pow(factor, power);
    for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] = not_known;
    sample.uncertainty = {};
    sample.as_measured.reset();
    scaled.push_back(sample);
  }
  return relative_rms(scaled, fit_of_low_order(scaled));
}

/// Why reciprocity cannot tell; empty if it can.
std::string no_reciprocity(const Looked& at) {
  constexpr double least = 20;
  if (const std::string few = too_few(at, true); !few.empty()) return few;
  const auto [smallest, largest] =
      std::ranges::minmax(at.samples, {}, [](const Sample& s) { return s.geometry.incident.theta; });
  const double from = degrees(smallest.geometry.incident.theta), to = degrees(largest.geometry.incident.theta);
  if (to - from >= least) return "";
  return "theta_i from " + rounded(from, 3) + " to " + rounded(to, 3) + " degrees, and reciprocity takes " +
         rounded(least, 2) + " between them";
}

/// Reciprocity tells whether f11 has a cosine of the receiver too many or too few.
void look_at_cosine(Inspection& result, const Looked& at) {
  if (const std::string few = no_reciprocity(at); !few.empty()) {
    result.untested.push_back({cosine, few});
    return;
  }
  const double as_is = left_with_cosine(at.samples, 0), divided = left_with_cosine(at.samples, -1),
               multiplied = left_with_cosine(at.samples, 1);
  const bool too_many = divided <= multiplied;
  const double other = std::max(std::min(divided, multiplied), exact_rms);
  const auto percent = [](double part) { return rounded(100 * std::max(part, exact_rms), 2) + " %"; };
  if (is_better(as_is, other))
    result.findings.push_back({cosine,
                               "a reciprocal f11 leaves " + percent(as_is) + ", but " + percent(other) +
                                   " after it is " + (too_many ? "divided" : "multiplied") + " by cos theta_r",
                               too_many ? "is it f cos theta_r? Call the column f_cos (columns f_cos=f11)"
                                        : "was it divided by cos theta_r once too often? Multiply the column by it",
                               {}});
  else if (!is_better(other, as_is))
    result.untested.push_back({cosine, "a reciprocal f11 leaves " + percent(as_is) + ", and " + percent(other) +
                                           " after it is " + (too_many ? "divided" : "multiplied") +
                                           " by cos theta_r: it takes several theta_i, and less noise"});
}

}  // namespace

Finding cosine_finding(std::span<const Sample> samples) {
  Looked at{without_fills(samples), {}};
  at.fitted = fit_of_low_order(at.samples);
  Inspection seen;
  look_at_cosine(seen, at);
  return seen.findings.empty() ? Finding{} : seen.findings.front();
}

namespace {

void look_at_azimuths(Inspection& result, const Looked& at) {
  for (const std::string& line : data_warnings(at.fitted))
    if (line.find("folded") != std::string::npos) {
      result.findings.push_back(
          {azimuths, line, "give phi_i and phi_r as they were, from -180 to 180 or 0 to 360", {}});
      return;
    }
  const Elements unknown = ~measured_elements(at.samples);
  constexpr std::array<std::size_t, 8> odd = {2, 3, 6, 7, 8, 9, 12, 13};
  const bool one_side = ((at.fitted.sides & negative_side) != 0) != ((at.fitted.sides & positive_side) != 0);
  if (!one_side) return;
  if (std::ranges::all_of(odd, [&](std::size_t e) { return unknown[e]; }))
    result.untested.push_back({azimuths, "none of the elements that change their sign with the side were measured"});
  else if (const std::string few = too_few(at, false); !few.empty())
    result.untested.push_back({azimuths, few});
}

/// What else the samples may be read as, as far as the residuals tell.
std::string as_good(std::span<const ConventionFit> fits) {
  std::vector<std::string> names;
  for (const ConventionFit& one : fits.subspan(1))
    if (!is_better(one.rms, fits.front().rms)) names.push_back(one.read_as);
  if (names.empty()) return "";
  std::string list = names.front();
  for (std::size_t i = 1; i < names.size(); ++i) list += "; " + names[i];
  return "residuals would be less than " + rounded(better_convention, 2) + " times as large " +
         (names.size() + 1 == fits.size() ? "however it is read" : "if read as " + list);
}

void look_at_frame(Inspection& result, const Looked& at) {
  const Elements unknown = ~measured_elements(at.samples);
  std::string why = unknown.count() >= 15 ? "f11 alone was measured" : too_few(at, false);
  if (why.empty()) {
    const auto fits = convention_fits(at.samples, inspected_orders);
    if (Finding found = convention_finding(fits); !found.fault.empty()) {
      result.findings.push_back(std::move(found));
      return;
    }
    why = fits.empty() ? "of the elements that frames mix, some were not measured" : as_good(fits);
  }
  if (!why.empty()) result.untested.push_back({convention_fault, why});
}

/// Of all samples of the wavelength of the fit.
std::vector<double> residuals_of(std::span<const Sample> samples, const Looked& at) {
  const FillValues fill_values(samples);
  std::vector<Sample> fitted;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (same_wavelength(samples[i].wavelength, samples.front().wavelength) && !fill_values.include(samples[i])) {
      fitted.push_back(samples[i]);
      places.push_back(i);
    }
  std::vector<double> result(samples.size(), not_known);
  const std::vector<Mueller> left = residuals(at.fitted.model, fitted);
  for (std::size_t i = 0; i < places.size(); ++i) result[places[i]] = left[i](0, 0);
  return result;
}

void look_at_fit(Inspection& result, std::span<const Sample> samples, const Looked& at) {
  const double wavelength = at.samples.front().wavelength;
  const Validity& validity = at.fitted.model.validity;
  result.sides = at.fitted.sides;
  result.f11_residual = relative_rms(at.samples, at.fitted);
  result.residuals = residuals_of(samples, at);
  result.unsupported = unsupported_share(validity, wavelength);
  result.hole = unsupported_line(validity, wavelength);
  result.hole_at = unsupported_part(validity, wavelength);
  result.missing = missing_shares(validity, wavelength);
}

struct Angles {
  double smallest = 90, largest = 0;  // degrees
};

Angles angles(std::span<const Sample> samples, Direction Geometry::*direction) {
  Angles result;
  for (const Sample& sample : samples) {
    const double theta = degrees((sample.geometry.*direction).theta);
    result = {std::min(result.smallest, theta), std::max(result.largest, theta)};
  }
  return result;
}

/// "11, 12, 21 and 22 in the frame sp (140 samples), all sixteen in the frame xy (60 samples)"
std::string elements_line(std::span<const Sample> samples) {
  const std::vector<SamplesInFrame> frames = by_own_frame(samples);
  std::string text;
  for (const auto& [own, count, measured] : frames) {
    text += (text.empty() ? "" : ", ") + (measured.all() ? "all sixteen" : element_names(measured));
    if (frames.size() > 1 || own != Frame::xy) text += " in the frame " + to_string(own);
    if (frames.size() > 1) text += " (" + counted(static_cast<long>(count), "sample") + ")";
  }
  return text;
}

std::string span_line(const Angles& a) { return rounded(a.smallest, 4) + " ... " + rounded(a.largest, 4) + " degrees"; }

}  // namespace

Inspection inspect(std::span<const Sample> samples, std::span<const long> numbers) {
  Inspection result;
  result.findings = row_findings(samples, numbers);
  if (samples.empty()) throw std::invalid_argument("there are no samples");
  result.residuals.assign(samples.size(), not_known);
  Looked at{without_fills(samples), {}};
  const auto leave_out = [&](const std::string& reason) {
    for (const char* fault : {scale, cosine, azimuths, convention_fault}) result.untested.push_back({fault, reason});
  };
  try {
    at.fitted = fit_of_low_order(at.samples);
    look_at_fit(result, samples, at);
    if (may_be_radians(at.samples)) {
      if (Finding unit = radian_finding(at.samples); !unit.fault.empty()) {
        result.findings.push_back(std::move(unit));
        leave_out("the angles are to be right first");
        return result;
      }
      result.untested.push_back({"angles in radians", "these would do as radians, and nothing tells"});
    }
    look_at_scale(result, at);
    look_at_cosine(result, at);
    look_at_azimuths(result, at);
    look_at_frame(result, at);
  } catch (const std::invalid_argument& error) {
    result.findings.push_back({"no fit", error.what(), "", {}});
    result.untested.clear();
    leave_out("there is no fit");
  }
  return result;
}

std::string to_string(const Untested& untested) { return "cannot be told: " + untested.fault + ": " + untested.reason; }

std::string verdict_line(const Inspection& seen) {
  if (!seen.findings.empty()) return "";
  return seen.untested.empty() ? "nothing seems to be wrong" : "nothing seems to be wrong, as far as can be told";
}

std::string sides_line(Sides sides) {
  if (sides == plane_of_incidence) return "in the plane of incidence only";
  if ((sides & negative_side) && (sides & positive_side)) return "on both sides of the plane of incidence";
  return "on one side of the plane of incidence";
}

std::vector<InspectionRow> inspection_rows(const Inspection& seen, std::span<const Sample> samples) {
  const bool uncertain = std::ranges::all_of(samples, has_uncertainty, in_own_frame);
  std::vector<InspectionRow> rows = {
      {"elements", elements_line(samples) + (uncertain ? ", with their uncertainties" : ", without uncertainties")},
      {"theta_i", span_line(angles(samples, &Geometry::incident))},
      {"theta_r", span_line(angles(samples, &Geometry::reflected)) + ", " + sides_line(seen.sides)},
      {"covered",
       rounded(std::round(100 * (1 - seen.unsupported)), 3) + " % of the pairs of directions within these angles"}};
  if (!seen.hole.empty()) rows.push_back({"", seen.hole});
  if (seen.f11_residual > exact_rms)
    rows.push_back(
        {"residual", rounded(100 * seen.f11_residual, 2) + " % of f11: noise, and what a fit of low order misses"});
  return rows;
}

}  // namespace mmbrdf
