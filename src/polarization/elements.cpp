// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/elements.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Complex = std::complex<double>;

void require_valid(const Film& film, double wavelength, double theta_i) {
  const auto require = [](bool good, const char* what, double value, const char* unit = "") {
    if (!good) throw std::invalid_argument(std::string("film: ") + what + " " + shortest(value) + unit);
  };
  require(wavelength > 0 && std::isfinite(wavelength), "wavelength of", in_nanometres(wavelength), " nm");
  require(theta_i >= 0 && theta_i < std::numbers::pi / 2, "angle of incidence of", in_degrees(theta_i),
          " degrees, must be from 0 to below 90");
  require(film.thickness >= 0 && std::isfinite(film.thickness), "thickness of", film.thickness);
  for (const Complex n : {film.film_index, film.substrate_index}) {
    require(n.real() > 0 && std::isfinite(n.real()), "refractive index of", n.real());
    require(n.imag() >= 0 && std::isfinite(n.imag()), "absorption index of", n.imag());
  }
}

/// A light wave in one medium at a given component along the surface: n and n cos θ.
struct Wave {
  Complex n, normal;
  Wave(Complex index, double sine) : n(index), normal(std::sqrt(index * index - sine * sine)) {}
};

Complex fresnel_s(const Wave& a, const Wave& b) { return (a.normal - b.normal) / (a.normal + b.normal); }

/// With p of the reflected beam as (s, p, k) right-handed has it: r_p = −r_s at normal incidence.
Complex fresnel_p(const Wave& a, const Wave& b) {
  const Complex left = b.n * b.n * a.normal, right = a.n * a.n * b.normal;
  return (left - right) / (left + right);
}

Complex with_layer(Complex outer, Complex inner, Complex round_trip) {
  return (outer + inner * round_trip) / (1. + outer * inner * round_trip);
}

}  // namespace

Mueller rotated(const Mueller& element, double azimuth) { return rotator(-azimuth) * element * rotator(azimuth); }

Mueller mueller(const DiattenuatorRetarder& element) {
  const auto& [tau, psi, delta] = element;
  const double c = tau * std::cos(2 * psi), s = tau * std::sin(2 * psi);
  Mueller m = diagonal(tau, tau, s * std::cos(delta), s * std::cos(delta));
  m(0, 1) = m(1, 0) = c;
  m(3, 2) = s * std::sin(delta);
  m(2, 3) = -m(3, 2);
  return m;
}

Mueller polarizer(double azimuth, double extinction, double phase) {
  if (!(extinction >= 0 && extinction <= 1))
    throw std::invalid_argument("extinction " + shortest(extinction) + " of a polarizer is not in [0, 1]");
  if (!std::isfinite(azimuth) || !std::isfinite(phase))
    throw std::invalid_argument("an angle of a polarizer is not finite");
  return rotated(mueller({(1 + extinction) / 2, std::atan(std::sqrt(extinction)), phase}), azimuth);
}

Mueller retarder(double retardance, double azimuth) {
  if (!std::isfinite(retardance) || !std::isfinite(azimuth))
    throw std::invalid_argument("an angle of a retarder is not finite");
  return rotated(mueller({1, std::numbers::pi / 4, retardance}), azimuth);
}

DiattenuatorRetarder reflection(const Film& film, double wavelength, double theta_i) {
  require_valid(film, wavelength, theta_i);
  const double sine = std::sin(theta_i);
  const Wave air(1, sine), layer(film.film_index, sine), below(film.substrate_index, sine);
  const Complex i(0, 1), round_trip = std::exp(4 * std::numbers::pi * i * layer.normal * film.thickness / wavelength);
  const Complex rs = with_layer(fresnel_s(air, layer), fresnel_s(layer, below), round_trip);
  const Complex rp = with_layer(fresnel_p(air, layer), fresnel_p(layer, below), round_trip);
  const DiattenuatorRetarder result{(std::norm(rs) + std::norm(rp)) / 2, std::atan2(std::abs(rp), std::abs(rs)),
                                    std::arg(rp * std::conj(rs))};
  if (!std::isfinite(result.tau) || !std::isfinite(result.delta))
    throw std::invalid_argument("film: indices or a thickness so large that no finite reflection is left");
  return result;
}

}  // namespace mmbrdf
