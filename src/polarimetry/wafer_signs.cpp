// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/wafer_signs.hpp"

// Which of the eight instruments it is. Eigenvalues tell ψ but for its side of 45 degrees, and |Δ|. What is stated, or
// a film whose thickness is fitted to what is known, gives each wafer the two signs from which the equations are
// solved. Then the readings themselves have signs, of all wafers together: they must be those that were stated, and
// must be nearer to the film than the three other choices, each at the thickness that suits it best.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "numerics/golden_section.hpp"
#include "text/numbers.hpp"

namespace mmbrdf::calibration {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int film_steps = 400;

/// A sign counts where the element of the matrix that has it is this many figures of merit from 0; a figure of merit
/// above the second number is one of contradictions.
constexpr double significance = 5, largest_scatter = 0.02;

double square(double x) { return x * x; }

double folded(double psi) { return std::min(psi, pi / 2 - psi); }

/// Sum of the squares of what the film is off ψ and Δ: signs that a wafer does not have do not count.
double squares(const Film& film, std::span<const SeenWafer> wafers, std::span<const Reference> references,
               double wavelength) {
  double sum = 0;
  for (const auto& [i, wafer, has_side, has_sign] : wafers) {
    const DiattenuatorRetarder model = reflection(film, wavelength, references[i].angle);
    sum += square(has_side ? wafer.psi - model.psi : folded(wafer.psi) - folded(model.psi)) +
           square(has_sign ? std::remainder(wafer.delta - model.delta, 2 * pi)
                           : std::abs(wafer.delta) - std::abs(model.delta));
  }
  return sum;
}

struct FilmFit {
  Film film;
  double misfit = 0;  ///< root mean square, radians
};

FilmFit fitted_film(std::span<const SeenWafer> wafers, std::span<const Reference> references,
                    const CalibrationOptions& options) {
  FilmFit result{*options.film, 0};
  const auto at = [&](double thickness) {
    result.film.thickness = thickness;
    return squares(result.film, wafers, references, options.wavelength);
  };
  const double given = options.film->thickness;
  const double best =
      given > 0 ? scanned_minimum(at, (1 - film_range) * given, (1 + film_range) * given, film_steps, 1e-9 * given) : 0;
  result.misfit = std::sqrt(at(best) / (2 * static_cast<double>(wafers.size())));
  return result;
}

std::string shown(double value) { return shortest(std::round(value * 1e4) / 1e4); }
std::string misfit_of(const FilmFit& fit) { return shortest(std::round(degrees(fit.misfit) * 100) / 100) + " degrees"; }

std::string off(const FilmFit& fit) {
  return "at " + shown(fit.film.thickness) + " um it is " + misfit_of(fit) + " off psi and delta";
}

int side_of(const DiattenuatorRetarder& element) { return element.psi < pi / 4 ? 1 : -1; }
int sign_of(const DiattenuatorRetarder& element) { return element.delta > 0 ? 1 : -1; }

void set_side(SeenWafer& wafer, int side) {
  if (side_of(wafer.element) != side) wafer.element.psi = pi / 2 - wafer.element.psi;
}

void set_sign(SeenWafer& wafer, int sign) { wafer.element.delta = sign * std::abs(wafer.element.delta); }

void use_stated(SeenWafer& wafer, const Reference& reference) {
  wafer.has_side = reference.s_exceeds_p != 0;
  wafer.has_sign = reference.delta_sign != 0;
  if (wafer.has_side) set_side(wafer, reference.s_exceeds_p);
  if (wafer.has_sign) set_sign(wafer, reference.delta_sign);
}

std::string stated(const char* what, int value) { return std::string(what) + " is stated as " + std::to_string(value); }

/// The stated sign of the wafer that is furthest from what the film, which fits them but for the signs, has there.
std::string contradiction(const FilmFit& film, std::span<const SeenWafer> wafers, std::span<const Reference> references,
                          double wavelength) {
  std::string text;
  double furthest = 0;
  for (const SeenWafer& wafer : wafers) {
    const Reference& reference = references[wafer.reference];
    const DiattenuatorRetarder model = reflection(film.film, wavelength, reference.angle);
    const auto consider = [&](bool has, double distance, const std::string& what) {
      if (!has || !(distance > furthest)) return;
      furthest = distance;
      text = "reference " + std::to_string(wafer.reference + 1) + ": " + what + ", which contradicts the film at " +
             shown(film.film.thickness) + " um";
    };
    consider(wafer.has_side, std::abs(wafer.element.psi - model.psi), stated("s_exceeds_p", reference.s_exceeds_p));
    consider(wafer.has_sign, std::abs(std::remainder(wafer.element.delta - model.delta, 2 * pi)),
             stated("delta_sign", reference.delta_sign));
  }
  return text;
}

void require_fitting(const FilmFit& fit, const Film& given) {
  if (!(fit.misfit < film_tolerance))
    throw std::invalid_argument("the film is not that of the wafers: " + off(fit) + ", rms, and nowhere within " +
                                shown(100 * film_range) + " % of " + shortest(given.thickness) + " um less");
}

/// For a film that fits the wafers without the signs that are stated.
void require_not_contradicted(const FilmFit& fit, std::span<const SeenWafer> wafers,
                              std::span<const Reference> references, const CalibrationOptions& options) {
  if (fit.misfit < film_tolerance) return;
  std::vector<SeenWafer> without(wafers.begin(), wafers.end());
  for (SeenWafer& wafer : without) wafer.has_side = wafer.has_sign = false;
  const FilmFit other = fitted_film(without, references, options);
  if (other.misfit < film_tolerance)
    throw std::invalid_argument(contradiction(other, wafers, references, options.wavelength));
}

/// The wafers as the readings show them, when the instrument is known.
std::vector<SeenWafer> seen(std::span<const FittedReference> references) {
  std::vector<SeenWafer> result;
  for (std::size_t i = 0; i < references.size(); ++i)
    if (references[i].kind == ReferenceKind::wafer)
      result.push_back({i, element_of(references[i].measured), true, true});
  return result;
}

/// What tells of a sign that it is that of the readings: an element of the matrix that has it.
struct Evidence {
  const char* name;
  int Reference::*stated;
  double (*element)(const DiattenuatorRetarder&);
};
constexpr std::array<Evidence, 2> facts{
    {{"s_exceeds_p", &Reference::s_exceeds_p, [](const DiattenuatorRetarder& e) { return std::cos(2 * e.psi); }},
     {"delta_sign", &Reference::delta_sign,
      [](const DiattenuatorRetarder& e) { return std::sin(2 * e.psi) * std::sin(e.delta); }}}};

/// Whether what is stated tells a fact. Throws if the readings have another sign.
bool told(const Evidence& fact, std::span<const SeenWafer> wafers, std::span<const Reference> references,
          double scatter) {
  bool result = false;
  for (const SeenWafer& wafer : wafers) {
    const int sign = references[wafer.reference].*fact.stated;
    const double element = fact.element(wafer.element);
    if (sign == 0 || std::abs(element) <= scatter) continue;
    if (sign * element < 0)
      throw std::invalid_argument("reference " + std::to_string(wafer.reference + 1) + ": " + stated(fact.name, sign) +
                                  ", but together with the other references its readings say " + std::to_string(-sign));
    result = true;
  }
  return result;
}

void require_told_by_film(const FilmFit& own, std::span<const SeenWafer> wafers, std::span<const Reference> references,
                          const CalibrationOptions& options, const std::array<bool, 2>& told) {
  for (const auto& [exchanged, opposite, what] : {std::tuple(true, false, "s and p exchanged"),
                                                  {false, true, "the other sign of delta"},
                                                  {true, true, "s and p exchanged and the other sign of delta"}}) {
    if ((exchanged && told[0]) || (opposite && told[1])) continue;
    std::vector<SeenWafer> others(wafers.begin(), wafers.end());
    for (SeenWafer& wafer : others) {
      if (exchanged) wafer.element.psi = pi / 2 - wafer.element.psi;
      if (opposite) wafer.element.delta = -wafer.element.delta;
    }
    const FilmFit other = fitted_film(others, references, options);
    const bool either = own.misfit < film_tolerance || other.misfit < film_tolerance;
    if (either && other.misfit < film_distinction * std::max(own.misfit, least_film_misfit))
      throw std::invalid_argument("the film leaves the signs of the wafers open: " + off(own) + ", and at " +
                                  shown(other.film.thickness) + " um, with " + what + ", " + misfit_of(other) +
                                  "; add wafer angles, or state the signs (columns s_exceeds_p, delta_sign)");
  }
}

void require_inside(const Film& found, const Film& given) {
  const double step = 2 * film_range / film_steps;
  if (given.thickness > 0 && std::abs(found.thickness / given.thickness - 1) > film_range - step)
    throw std::invalid_argument("the thickness of the film comes out at " + shown(found.thickness) +
                                " um, an end of the range of " + shown(100 * film_range) + " % around the given " +
                                shortest(given.thickness) + " um: give one that is nearer");
}

/// Of a mixture of references, and what its film says is no help.
std::string mixture(double merit) {
  return "figure of merit " + shortest(std::round(merit * 1e3) / 1e3) +
         ": are states or references mixed up, or angles wrong? ";
}

void use_film(Calibration& calibration, std::span<const SeenWafer> wafers, std::span<const Reference> references,
              const CalibrationOptions& options, const std::array<bool, 2>& told) {
  const FilmFit own = fitted_film(wafers, references, options);
  require_told_by_film(own, wafers, references, options, told);
  require_fitting(own, *options.film);
  require_inside(own.film, *options.film);
  calibration.film_thickness = own.film.thickness;
  calibration.film_misfit = own.misfit;
}

}  // namespace

DiattenuatorRetarder element_of(const Mueller& m) {
  const double c = (m(0, 1) + m(1, 0)) / 2, cosine = (m(2, 2) + m(3, 3)) / 2, sine = (m(3, 2) - m(2, 3)) / 2;
  return {m(0, 0), std::atan2(std::hypot(cosine, sine), c) / 2, std::atan2(sine, cosine)};
}

void give_signs(std::vector<SeenWafer>& wafers, std::span<const Reference> references,
                const CalibrationOptions& options) {
  for (SeenWafer& wafer : wafers) use_stated(wafer, references[wafer.reference]);
  if (!options.film || wafers.empty()) return;
  const FilmFit fit = fitted_film(wafers, references, options);
  require_not_contradicted(fit, wafers, references, options);
  require_fitting(fit, *options.film);
  for (SeenWafer& wafer : wafers) {
    const DiattenuatorRetarder model = reflection(fit.film, options.wavelength, references[wafer.reference].angle);
    if (!wafer.has_side) set_side(wafer, side_of(model));
    if (!wafer.has_sign) set_sign(wafer, sign_of(model));
  }
}

void require_signs(Calibration& calibration, std::span<const Reference> references, const CalibrationOptions& options) {
  require_signs_of_retarders(calibration.references, references);
  const std::vector<SeenWafer> wafers = seen(calibration.references);
  if (wafers.empty()) return;
  const double merit = calibration.figure_of_merit.total;
  const double scatter = significance * std::min(merit, largest_scatter);
  std::array<bool, 2> is_told{};
  for (std::size_t k = 0; k < 2; ++k) is_told[k] = told(facts[k], wafers, references, scatter);
  if (options.film) {
    try {
      return use_film(calibration, wafers, references, options, is_told);
    } catch (const std::invalid_argument&) {
      if (merit > doubtful_merit) throw std::invalid_argument(mixture(merit) + "The film does not tell the signs");
      throw;
    }
  }
  for (std::size_t k = 0; k < 2; ++k)
    if (!is_told[k])
      throw std::invalid_argument(std::string("the wafers leave the instrument open: ") + facts[k].name +
                                  " is lost in the noise at all their angles; add wafer angles");
}

void require_signs_of_retarders(std::span<const FittedReference> found, std::span<const Reference> references) {
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i].kind != ReferenceKind::retarder) continue;
    const int sign = references[i].delta_sign < 0 ? -1 : 1;
    const DiattenuatorRetarder& element = found[i].element;
    if (sign * std::sin(2 * element.psi) * std::sin(element.delta) < -clear_sign)
      throw std::invalid_argument("reference " + std::to_string(i + 1) + ": " + stated("delta_sign", sign) +
                                  ", but together with the other references its readings say " + std::to_string(-sign));
  }
}

void give_orientation(Unknowns& unknowns, const CalibrationOptions& options) {
  if (!options.polarizer_near)
    throw std::invalid_argument("retarders leave open whether the polarizer's azimuth at dial 0 is " +
                                shown(degrees(unknowns.offset)) +
                                " degrees or 90 more: say roughly which, or add a wafer");
  const double off = std::remainder(unknowns.offset - *options.polarizer_near, pi);
  if (std::abs(std::abs(off) - pi / 4) < radians(10))
    throw std::invalid_argument("the polarizer's azimuth at dial 0 is " + shown(degrees(unknowns.offset)) +
                                " degrees or 90 more, and the given " + shown(degrees(*options.polarizer_near)) +
                                " does not tell which");
  if (std::abs(off) < pi / 4) return;
  unknowns.offset = std::fmod(unknowns.offset + pi / 2, pi);
  unknowns.generator.bottomRows(3) *= -1;
  unknowns.analyzer.bottomRows(3) *= -1;
}

}  // namespace mmbrdf::calibration
