// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/radiometry/certificate.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "basis/spectral.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "numerics/eigen_index.hpp"
#include "text/numbers.hpp"

// With slopes s(λ) over the coefficients a of f11, of all powers, the reflectance is R(λ) D(λ), D = s · a. A certified
// value c gives R = c / D, and
//
//   dR = dc / D − (R / D) s · da,   so that   d(R D) = dc.

namespace mmbrdf {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string at(const CertifiedReflectance& one) {
  return " of the certificate at " + shortest(in_nanometres(one.wavelength)) + " nm";
}

void require_valid(const CertifiedReflectance& one, const Validity& validity) {
  require_wavelength(one.wavelength);
  if (leaves_known_range(outside(validity, one.wavelength)))
    throw std::invalid_argument("the model was not fitted at " + shortest(in_nanometres(one.wavelength)) +
                                " nm, where the certificate has a value");
  if (!(one.value > 0 && one.value <= largest_reflectance))
    throw std::invalid_argument("reflectance " + shortest(one.value) + at(one) + ": must be in (0, " +
                                shortest(largest_reflectance) + "], a part of 1");
  if (!(one.uncertainty >= 0 && one.uncertainty <= one.value))
    throw std::invalid_argument("uncertainty " + shortest(one.uncertainty) + at(one) + ": must be in [0, " +
                                shortest(one.value) + "]");
  if (!(one.theta >= 0 && one.theta < std::numbers::pi / 2))
    throw std::invalid_argument("polar angle " + shortest(in_degrees(one.theta)) + " degrees" + at(one) +
                                ": must be in [0, 90)");
}

std::vector<CertifiedReflectance> sorted(std::span<const CertifiedReflectance> certificate, const Validity& validity) {
  std::vector<CertifiedReflectance> result(certificate.begin(), certificate.end());
  if (result.empty()) throw std::invalid_argument("a certificate without values");
  std::ranges::sort(result, {}, &CertifiedReflectance::wavelength);
  for (const CertifiedReflectance& one : result) require_valid(one, validity);
  const auto twice = std::ranges::adjacent_find(result, {}, &CertifiedReflectance::wavelength);
  if (twice != result.end()) throw std::invalid_argument("two values" + at(*twice));
  return result;
}

/// s at one wavelength: those of one power, repeated.
VectorXd slopes(const Model& model, const CertifiedReflectance& one) {
  const Block& f11 = model.blocks.front().block;
  const std::vector<double> s = directional_hemispherical_slopes(f11, model.family, model.mapping, {one.theta, 0});
  const Eigen::Map<const VectorXd> single(s.data(), index(s.size()));
  return repetition(single.size(), powers_of(one.wavelength, model.powers)) * single;
}

/// The fitted wavelengths as far as the certificate goes, and its ends.
std::vector<double> narrowed(const std::vector<double>& fitted, const std::vector<double>& certified) {
  std::vector<double> result{certified.front()};
  for (const double wavelength : fitted)
    if (wavelength > certified.front() && wavelength < certified.back()) result.push_back(wavelength);
  if (certified.size() > 1) result.push_back(certified.back());
  return result;
}

/// "3 reflectances, 443 to 600 nm"
std::string described(const std::vector<CertifiedReflectance>& values) {
  return std::to_string(values.size()) + " reflectances, " + shortest(in_nanometres(values.front().wavelength)) +
         " to " + shortest(in_nanometres(values.back().wavelength)) + " nm";
}

}  // namespace

CertifiedModel certified(Model model, std::span<const CertifiedReflectance> certificate) {
  require_valid(model);
  const std::vector<CertifiedReflectance> values = sorted(certificate, model.validity);
  const FittedBlock& f11 = model.blocks.front();
  const Eigen::Map<const VectorXd> a(f11.coefficients.data(), index(f11.coefficients.size()));
  CertifiedModel result;
  ReflectanceTable table;
  MatrixXd of_coefficients(index(values.size()), a.size());  // dR / da
  VectorXd of_certificate(index(values.size()));             // u(c) / D
  for (Eigen::Index j = 0; const CertifiedReflectance& one : values) {
    const VectorXd s = slopes(model, one);
    const double d = s.dot(a), factor = one.value / d;
    if (!(d > 0)) throw std::invalid_argument("the reflectance of the model is not positive" + at(one));
    of_coefficients.row(j) = -factor / d * s.transpose();
    of_certificate(j++) = one.uncertainty / d;
    const double change = std::abs(factor / model.reflectance.at(one.wavelength) - 1);
    if (change >= result.change) result = {{}, change, one.wavelength};
    table.wavelengths.push_back(one.wavelength);
    table.values.push_back(factor);
    if (model.posterior) table.certified_theta.push_back(one.theta);
  }
  MatrixXd covariance = of_certificate * of_certificate.transpose(), with_f11 = MatrixXd::Zero(a.size(), a.size());
  if (!f11.covariance.empty()) with_f11 = Eigen::Map<const MatrixXd>(f11.covariance.data(), a.size(), a.size());
  with_f11 = (of_coefficients * with_f11).transpose().eval();  // transposed: row-major
  covariance += of_coefficients * with_f11;
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
  table.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  table.covariance_with_f11.assign(with_f11.data(), with_f11.data() + with_f11.size());
  model.provenance["certificate"] = described(values);
  model.validity.wavelengths = narrowed(model.validity.wavelengths, table.wavelengths);
  model.reflectance = std::move(table);
  result.model = std::move(model);
  return result;
}

}  // namespace mmbrdf
