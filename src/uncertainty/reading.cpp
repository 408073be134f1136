// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/uncertainty/reading.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "mixed/readings.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "text/numbers.hpp"

// With x = (h, x_free) the row of all columns, u² that of the isotropic mean and V the covariance of all columns:
//   at some azimuth   u² + Σ_free x_j² v_j + σ²
//   at its own        u² + xᵀV x − hᵀV h + σ²,   the value g·a + x_free · b with the posterior means b

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double largest_theta = std::numbers::pi / 2 - 1e-9;  // the noise has no bound beyond

struct ReadBlock {
  MixedColumns columns;
  double noise_variance;
  VectorXd free_variances, free_mean;
};

}  // namespace

struct ReadingPrediction::State {
  Model model;
  std::size_t node;
  PreparedModel prepared;
  PreparedUncertainty uncertainty;
  std::vector<ReadBlock> blocks;
  mutable std::once_flag once;
  mutable std::vector<MatrixXd> covariances;  // of all columns

  State(const Model& from, std::size_t at)
      : model(from),
        node(at),
        prepared(prepare(from, here().wavelength)),
        uncertainty(prepare_uncertainty(from, here().wavelength)) {
    for (std::size_t b = 0; b < here().blocks.size(); ++b) {
      const BlockPosterior& p = here().blocks[b];
      const MixedColumns columns(model.posterior->blocks()[b], model.mapping, model.posterior->data().unread);
      const Index free = columns.size() - columns.isotropic_count();
      const VectorXd v = prior_of(columns).variances(
          Eigen::Map<const VectorXd>(p.hyperparameters.data(), static_cast<Index>(p.hyperparameters.size())));
      blocks.push_back({columns, p.noise_variance, v.tail(free),
                        Eigen::Map<const Eigen::VectorXf>(p.free_mean.data(), free).cast<double>()});
    }
  }

  const PosteriorAt& here() const { return model.posterior->data().wavelengths[node]; }

  const MatrixXd& covariance(std::size_t block) const {
    std::call_once(once, [&] {
      for (std::size_t b = 0; b < blocks.size(); ++b)
        covariances.push_back(covariance_of_all(model.posterior->data(), here(), here().blocks[b], blocks[b].columns));
    });
    return covariances[block];
  }

  PredictedReading reading(const Geometry& geometry, bool own) const;
};

PredictedReading ReadingPrediction::State::reading(const Geometry& geometry, bool own) const {
  const Mueller f = prepared.evaluate(geometry);
  if (std::max(geometry.incident.theta, geometry.reflected.theta) > largest_theta)
    throw std::invalid_argument("a reading at a polar angle of 90 degrees has no bounded noise");
  PredictedReading result{normalized(f), standard_uncertainty(uncertainty.normalized(geometry))};
  result.value(0, 0) = f(0, 0);
  const ReadingLaw& law = here().law;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto& [columns, noise, variances, mean] = blocks[b];
    const bool is_f11 = feeds_f11(columns.isotropic());
    const double scale = is_f11 ? prepared.reflectance() : 1;
    const VectorXd relative_to =
        is_f11 && law.relative ? first_f11(here().f11, columns.mapping(), {&geometry, 1}) : VectorXd();
    const double weight = reading_weights(law, {&geometry, 1}, relative_to)(0);
    const MatrixXd rows = columns.at({&geometry, 1});
    for (Index e = 0; e < columns.elements(); ++e) {
      const std::size_t element = columns.isotropic().elements[static_cast<std::size_t>(e)].index();
      const VectorXd x = rows.row(e), free = x.tail(variances.size()), h = x.head(columns.isotropic_count());
      double variance = noise / (weight * weight);
      if (own) {
        const MatrixXd& v = covariance(b);
        variance += x.dot(v * x) - h.dot(v.topLeftCorner(h.size(), h.size()) * h);
        result.value.elements[element] += scale * free.dot(mean);
      } else {
        variance += free.cwiseAbs2().dot(variances);
      }
      double& u = result.uncertainty.elements[element];
      u = std::sqrt(std::max(u * u + scale * scale * variance, 0.0));
    }
  }
  return result;
}

ReadingPrediction::ReadingPrediction(std::shared_ptr<const State> state) : state_(std::move(state)) {}

PredictedReading ReadingPrediction::at_some_azimuth(const Geometry& geometry) const {
  return state_->reading(geometry, false);
}
PredictedReading ReadingPrediction::at_its_azimuth(const Geometry& geometry) const {
  return state_->reading(geometry, true);
}

ReadingPrediction predict_readings(const Model& model, double wavelength) {
  if (!model.posterior)
    throw std::invalid_argument(
        "the model says nothing of readings: it is of a fit whose uncertainties hold for the "
        "noise alone");
  const std::vector<PosteriorAt>& list = model.posterior->data().wavelengths;
  for (std::size_t node = 0; node < list.size(); ++node)
    if (std::abs(list[node].wavelength - wavelength) < 1e-7)
      return ReadingPrediction(std::make_shared<const ReadingPrediction::State>(model, node));
  throw std::invalid_argument("readings are predicted at the fitted wavelengths, and " +
                              shortest(in_nanometres(wavelength)) + " nm is none of them");
}

}  // namespace mmbrdf
