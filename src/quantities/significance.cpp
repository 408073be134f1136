// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/significance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

constexpr double unknown_variance = std::numeric_limits<double>::quiet_NaN();

/// The variances of f11 and of the other elements divided by it, of a model at many places.
class Variances {
 public:
  explicit Variances(const Model& model, std::span<const TypeBTerm> terms = {})
      : terms_(terms), prepared_([&model](double wavelength) {
          return Prepared{prepare(model, wavelength), prepare_uncertainty(model, wavelength)};
        }) {}

  Mueller at(const Sample& sample) {
    const Prepared& here = prepared_(sample.wavelength);
    const MuellerCovariance all = terms_.empty() ? here.uncertainty.evaluate(sample.geometry)
                                                 : budget(here.model, here.uncertainty, terms_, sample.geometry).total;
    const MuellerCovariance v = normalized(all, here.model.evaluate(sample.geometry));
    Mueller result;
    for (std::size_t e = 0; e < 16; ++e) result.elements[e] = std::max(v(e, e), 0.0);
    return result;
  }

  bool dark(const Sample& sample) { return !(prepared_(sample.wavelength).model.f11(sample.geometry) > 0); }

 private:
  struct Prepared {
    PreparedModel model;
    PreparedUncertainty uncertainty;
  };
  std::span<const TypeBTerm> terms_;
  AtWavelengths<std::function<Prepared(double)>> prepared_;
};

/// Where it is known.
Mueller variances_of(const Sample& sample) {
  Mueller result;
  for (std::size_t e = 0; e < 16; ++e) {
    const double u = sample.uncertainty.elements[e];
    result.elements[e] = u > 0 ? u * u : unknown_variance;
  }
  return result;
}

void add_ratio(Significance& total, double d, double u, const Sample& sample) {
  const double ratio = std::abs(d) / u;
  ++total.samples;
  total.u += u * u;
  total.rms += ratio * ratio;
  total.mean += ratio;
  total.within += ratio <= Significance::coverage ? 1 : 0;
  total.beyond += ratio > 2 ? 1 : 0;
  if (ratio <= total.largest && total.wavelength > 0) return;
  total.largest = ratio;
  total.wavelength = sample.wavelength;
  total.geometry = sample.geometry;
}

/// Sums of all elements, and what they are divided by.
class Sums {
 public:
  Sums() {
    for (Significance& total : totals_) total.within = 0;
  }

  void add(const Mueller& difference, const Mueller& variance, const Sample& sample) {
    constexpr double rounding = 1e-10;  // of an element that is 0 by symmetry
    for (std::size_t e = 0; e < 16; ++e) {
      const double u = std::sqrt(variance.elements[e]), d = difference.elements[e];
      if (u > rounding && !std::isnan(d)) add_ratio(totals_[e], d, u, sample);
    }
  }

  std::array<Significance, 16> means() const {
    std::array<Significance, 16> result = totals_;
    for (Significance& total : result) {
      const auto count = static_cast<double>(std::max(total.samples, 1L));
      total.u = std::sqrt(total.u / count);
      total.rms = std::sqrt(total.rms / count);
      total.mean /= count;
      total.within = total.samples > 0 ? total.within / count : 1;
      total.beyond /= count;
    }
    return result;
  }

 private:
  std::array<Significance, 16> totals_;
};

}  // namespace

std::array<Significance, 16> significance(const Model& first, const Model& second, std::span<const Sample> of_second,
                                          std::span<const TypeBTerm> terms) {
  const std::vector<Mueller> differences = residuals(first, of_second);
  Variances of_first(first, terms), of_other(second);
  Sums sums;
  for (std::size_t s = 0; s < of_second.size(); ++s)
    if (!of_first.dark(of_second[s]))
      sums.add(differences[s], of_first.at(of_second[s]) + of_other.at(of_second[s]), of_second[s]);
  return sums.means();
}

std::array<Significance, 16> significance(const Model& model, std::span<const Sample> samples,
                                          std::span<const TypeBTerm> terms) {
  const std::vector<Mueller> differences = residuals(model, samples);
  Variances of_model(model, terms);
  Sums sums;
  for (std::size_t s = 0; s < samples.size(); ++s)
    if (has_uncertainty(samples[s]) && !of_model.dark(samples[s]))
      sums.add(differences[s], of_model.at(samples[s]) + variances_of(samples[s]), samples[s]);
  return sums.means();
}

std::array<Significance, 16> significance(std::span<const Sample> first, std::span<const Sample> second) {
  if (first.size() != second.size()) throw std::invalid_argument("samples to compare must be as many");
  Sums sums;
  for (std::size_t s = 0; s < first.size(); ++s) {
    Mueller difference = second[s].normalized - first[s].normalized;
    difference(0, 0) = second[s].f11 - first[s].f11;
    sums.add(difference, variances_of(first[s]) + variances_of(second[s]), second[s]);
  }
  return sums.means();
}

}  // namespace mmbrdf
