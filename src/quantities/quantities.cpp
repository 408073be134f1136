// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/quantities.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

#include "mmbrdf/polarization/analysis.hpp"
#include "mmbrdf/polarization/analysis_batch.hpp"
#include "mmbrdf/polarization/gradients.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using M = const Mueller&;
using S = const Stokes&;

constexpr unsigned all_of_them = 0xffff, first_row = 0x000f, first_column = 0x1111, s_and_p = 0x0033;

using Values = std::size_t (*)(std::span<const Mueller>, std::span<double>, const MatricesOptions&);

/// A row for what does not take light.
template <double (*value)(M), Mueller (*gradient)(M)>
constexpr Quantity of_matrix(std::string_view name, std::string_view meaning, Elements needs = all_of_them,
                             Values values = nullptr, double Ratios::*ratio = nullptr) {
  return {
      name,   "",   meaning, false, false, needs, [](M m, S) { return value(m); }, [](M m, S) { return gradient(m); },
      values, ratio};
}

template <double PolarizedBrdf::*part, Mueller PolarizedBrdfGradients::*slopes>
constexpr Quantity polarized(std::string_view name, std::string_view meaning) {
  return {name,
          "sr^-1",
          meaning,
          true,
          false,
          s_and_p,
          [](M m, S) { return co_and_cross_polarized(m).*part; },
          [](M, S) { return co_and_cross_polarized_gradients().*slopes; }};
}

/// (f_ss + f_pp) / 2 > 0; half of it is never beyond the largest double.
double half_co_polarized(const PolarizedBrdf& f) {
  const double half = f.ss / 2 + f.pp / 2;
  if (!(half > 0)) throw std::invalid_argument("f_ss + f_pp = " + shortest(2 * half) + ", must be positive");
  return half;
}

double bounded(double x) {
  constexpr double largest = std::numeric_limits<double>::max();
  return std::clamp(x, -largest, largest);
}

double depolarization_ratio(M m) {
  if (!(m(0, 0) > 0)) depolarization(m);  // refuses
  const PolarizedBrdf f = co_and_cross_polarized(m);
  return bounded((f.sp / 2 + f.ps / 2) / half_co_polarized(f));
}

Mueller depolarization_ratio_gradient(M m) {
  const PolarizedBrdfGradients g = co_and_cross_polarized_gradients();
  const double half = half_co_polarized(co_and_cross_polarized(m));
  Mueller slopes = g.sp + g.ps - depolarization_ratio(m) * (g.ss + g.pp);
  for (double& slope : slopes.elements) slope = bounded(slope / 2 / half);
  return slopes;
}

/// M · light, of light that can exist.
Stokes scattered(M m, S light) {
  degree_of_polarization(light);  // refuses
  const Stokes result = m * light;
  if (!std::ranges::all_of(result, [](double s) { return std::isfinite(s); }))
    throw std::invalid_argument("the scattered light is not finite");
  return result;
}

/// Of component k of the scattered light.
Mueller scattered_gradient(std::size_t k, S light) {
  Mueller result;
  std::ranges::copy(light, result.elements.begin() + static_cast<std::ptrdiff_t>(4 * k));
  return result;
}

template <std::size_t k>
constexpr Quantity component(std::string_view name, std::string_view meaning) {
  return {name,
          "sr^-1",
          meaning,
          true,
          true,
          first_row << 4 * k,
          [](M m, S light) { return scattered(m, light)[k]; },
          [](M m, S light) { return scattered(m, light), scattered_gradient(k, light); }};
}

struct LinearPart {
  double s2, s3;
};

/// Of the scattered light, none of it from rounding.
LinearPart linear_part(M m, S light) {
  constexpr double rounding = 1e-14;
  const Stokes s = scattered(m, light);
  double largest = 0;
  for (const double element : m.elements) largest = std::max(largest, std::abs(element));
  const auto part = [&](double x) { return std::abs(x) > rounding * largest * light[0] ? x : 0; };
  if (!(s[0] > 0)) throw std::invalid_argument("the scattered light has S1 = " + shortest(s[0]));
  const LinearPart result{part(s[1]), part(s[2])};
  if (result.s2 == 0 && result.s3 == 0) throw std::invalid_argument("the scattered light has no linear polarization");
  return result;
}

double orientation_deg(M m, S light) {
  const auto [s2, s3] = linear_part(m, light);
  return degrees(std::atan2(s3, s2)) / 2;
}

/// d ½ atan2(S3, S2) = (S2 dS3 − S3 dS2) / 2 (S2² + S3²)
Mueller orientation_deg_gradient(M m, S light) {
  const auto [s2, s3] = linear_part(m, light);
  const double length = std::hypot(s2, s3), factor = degrees(1) / 2 / length;
  return factor * (s2 / length) * scattered_gradient(2, light) - factor * (s3 / length) * scattered_gradient(1, light);
}

using P = PolarizedBrdf;
using G = PolarizedBrdfGradients;

constexpr Quantity table[] = {
    of_matrix<depolarization, depolarization_gradient>(
        "depolarization", "0 for a perfect depolarizer, 1 where no light is depolarized (Gil and Bernabeu)",
        all_of_them, depolarization, &Ratios::depolarization),
    polarized<&P::ss, &G::ss>("f_ss", "BRDF from s- to s-polarized light"),
    polarized<&P::sp, &G::sp>("f_sp", "BRDF from s- to p-polarized light"),
    polarized<&P::ps, &G::ps>("f_ps", "BRDF from p- to s-polarized light"),
    polarized<&P::pp, &G::pp>("f_pp", "BRDF from p- to p-polarized light"),
    of_matrix<depolarization_ratio, depolarization_ratio_gradient>(
        "depolarization_ratio", "linear depolarization ratio, (f_sp + f_ps) / (f_ss + f_pp), frame sp", s_and_p),
    of_matrix<diattenuation, diattenuation_gradient>("diattenuation", "length of (M12, M13, M14) / M11", first_row,
                                                     diattenuation, &Ratios::diattenuation),
    of_matrix<polarizance, polarizance_gradient>("polarizance", "length of (M21, M31, M41) / M11", first_column,
                                                 polarizance, &Ratios::polarizance),
    of_matrix<realizability_margin, realizability_margin_gradient>(
        "eigenvalue_min", "smallest eigenvalue of the coherency matrix / M11: negative for what cannot exist",
        all_of_them, realizability_margin, &Ratios::realizability_margin),
    of_matrix<purity, purity_gradient>("purity", "1/4 for a perfect depolarizer, 1 for a Jones matrix", all_of_them,
                                       purity, &Ratios::purity),
    of_matrix<entropy, entropy_gradient>(
        "entropy", "of the coherency eigenvalues: 1 for a perfect depolarizer, 0 for a Jones matrix", all_of_them,
        entropy, &Ratios::entropy),
    component<0>("scattered_S1", "scattered light: intensity"),
    component<1>("scattered_S2", "scattered light: s- minus p-polarized"),
    component<2>("scattered_S3", "scattered light: at +45 minus at -45 degrees, from s towards p"),
    component<3>("scattered_S4", "scattered light: left- minus right-handed"),
    {"degree_of_polarization", "", "of the scattered light", false, true, all_of_them, degree_of_polarization,
     degree_of_polarization_gradient},
    {"orientation_deg", "deg", "scattered light: angle of linear polarization from s to p, -90 to 90", true, true,
     first_row | first_row << 4 | first_row << 8, orientation_deg, orientation_deg_gradient},
};

constexpr std::size_t without_light =
    static_cast<std::size_t>(std::ranges::find(table, true, &Quantity::takes_light) - std::begin(table));

}  // namespace

std::span<const Quantity> quantities(bool with_light) {
  return std::span(table).first(with_light ? std::size(table) : without_light);
}

bool is_known(const Quantity& quantity, const Mueller& m, const Stokes& light) {
  Elements needs = quantity.needs;
  for (std::size_t column = 0; column < 4 && quantity.takes_light; ++column)
    if (light[column] == 0) needs &= ~Elements(first_column << column);
  return (needs & unknown_elements(m)).none();
}

const Quantity& quantity(std::string_view name) {
  const auto found = std::ranges::find(table, name, &Quantity::name);
  if (found == std::end(table)) throw std::invalid_argument("quantity '" + std::string(name) + "' is not known");
  return *found;
}

}  // namespace mmbrdf
