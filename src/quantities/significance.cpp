// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/quantities/significance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "mmbrdf/model/at_wavelengths.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/comparison.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

namespace mmbrdf {
namespace {

/// The variances of f11 and of the other elements divided by it, of a model at many places.
class Variances {
 public:
  explicit Variances(const Model& model)
      : prepared_([&model](double wavelength) {
          return Prepared{prepare(model, wavelength), prepare_uncertainty(model, wavelength)};
        }) {}

  Mueller at(const Sample& sample) {
    const Prepared& here = prepared_(sample.wavelength);
    const MuellerCovariance v =
        normalized(here.uncertainty.evaluate(sample.geometry), here.model.evaluate(sample.geometry));
    Mueller result;
    for (std::size_t e = 0; e < 16; ++e) result.elements[e] = std::max(v(e, e), 0.0);
    return result;
  }

 private:
  struct Prepared {
    PreparedModel model;
    PreparedUncertainty uncertainty;
  };
  AtWavelengths<std::function<Prepared(double)>> prepared_;
};

void add(Significance& total, double ratio, const Sample& sample) {
  ++total.samples;
  total.mean += ratio;
  total.within += ratio <= Significance::coverage ? 1 : 0;
  if (ratio <= total.largest && total.wavelength > 0) return;
  total.largest = ratio;
  total.wavelength = sample.wavelength;
  total.geometry = sample.geometry;
}

}  // namespace

std::array<Significance, 16> significance(const Model& first, const Model& second, std::span<const Sample> of_second) {
  constexpr double rounding = 1e-10;  // of an element that is 0 by symmetry
  const std::vector<Mueller> differences = residuals(first, of_second);
  Variances of_first(first), of_other(second);
  std::array<Significance, 16> result;
  for (Significance& total : result) total.within = 0;
  for (std::size_t s = 0; s < of_second.size(); ++s) {
    const Mueller variance = of_first.at(of_second[s]) + of_other.at(of_second[s]);
    for (std::size_t e = 0; e < 16; ++e) {
      const double u = std::sqrt(variance.elements[e]);
      if (u > rounding && !std::isnan(differences[s].elements[e]))
        add(result[e], std::abs(differences[s].elements[e]) / u, of_second[s]);
    }
  }
  for (Significance& total : result) {
    const auto count = static_cast<double>(total.samples);
    total.mean = total.samples > 0 ? total.mean / count : 0;
    total.within = total.samples > 0 ? total.within / count : 1;
  }
  return result;
}

}  // namespace mmbrdf
