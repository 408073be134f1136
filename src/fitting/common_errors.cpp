// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/fitting/common_errors.hpp"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mixed/readings.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/dense.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void require_fitting(const Model& model, std::span<const Sample> samples, std::span<const SampleChanges> errors,
                     std::span<const Mueller> weights) {
  if (model.powers != 0) throw std::invalid_argument("the model has powers of the wavelength");
  if (!model.reflectance.covariance.empty())
    throw std::invalid_argument("the reflectance that f11 is divided by comes from samples of its own");
  if (model.posterior) throw std::invalid_argument("the model has a posterior in place of a covariance");
  if (samples.empty()) throw std::invalid_argument("no samples");
  for (const Sample& sample : samples)
    if (!same_wavelength(sample.wavelength, samples[0].wavelength))
      throw std::invalid_argument("samples of more than one wavelength");
  for (const SampleChanges& error : errors)
    if (error.size() != samples.size())
      throw std::invalid_argument(std::to_string(error.size()) + " changes of " + std::to_string(samples.size()) +
                                  " samples");
  if (!weights.empty() && weights.size() != samples.size())
    throw std::invalid_argument(std::to_string(weights.size()) + " weights of " + std::to_string(samples.size()) +
                                " samples");
}

/// XᵀWX and XᵀW dy of one block, a column for each error.
struct Normal {
  MatrixXd matrix, vectors;
};

std::vector<Normal> empty_normals(const Model& model, std::size_t errors) {
  std::vector<Normal> result;
  for (const FittedBlock& fitted : model.blocks) {
    const auto size = static_cast<Index>(fitted.coefficients.size());
    result.push_back({MatrixXd::Zero(size, size), MatrixXd::Zero(size, static_cast<Index>(errors))});
  }
  return result;
}

/// F = f11 m, and only block 11 moves f11: the slopes of m are those of F over f11. f11 is fitted over the reflectance:
/// `units` are what slopes of F and changes of a sample are divided by, for element 11 and for the others.
struct Units {
  double slope, change;
};
void add_sample(std::vector<Normal>& normals, const Model& model, const MuellerGradient& gradient,
                const std::array<Units, 2>& units, std::span<const Mueller> changes, const Mueller* weights) {
  const Eigen::Map<const RowMajor> slopes(gradient.values.data(), 16, static_cast<Index>(gradient.values.size() / 16));
  Index first = 0;
  for (std::size_t b = 0; b < normals.size(); ++b) {
    auto& [matrix, vectors] = normals[b];
    for (const Element& element : model.blocks[b].block.elements) {
      const std::size_t e = element.index();
      const auto& [slope, change] = units[e == 0 ? 0 : 1];
      const Eigen::VectorXd x = slopes.row(static_cast<Index>(e)).segment(first, matrix.rows()).transpose() / slope;
      const double weight = weights ? weights->elements[e] : 1;
      matrix.selfadjointView<Eigen::Lower>().rankUpdate(x, weight);
      for (std::size_t k = 0; k < changes.size(); ++k)
        vectors.col(static_cast<Index>(k)) += weight * changes[k].elements[e] / change * x;
    }
    first += matrix.rows();
  }
}

/// There must be a covariance to add to.
void require_covariance(const FitResult& fitted) {
  for (std::size_t b = 0; b < fitted.model.blocks.size(); ++b) {
    const FittedBlock& block = fitted.model.blocks[b];
    if (block.covariance.empty())
      throw std::invalid_argument("block " + block.block.name +
                                  " has no covariance to which that of the instrument could be added: " +
                                  counted(fitted.solutions[b].rows, "row") + " for " +
                                  counted(static_cast<long>(block.coefficients.size()), "coefficient") +
                                  " leave no degrees of freedom; take lower orders, or more samples");
  }
}

/// XᵀW² D of the columns of a block and these errors of the samples.
MatrixXd weighted_products(const MixedColumns& columns, const PosteriorAt& at, std::span<const Sample> samples,
                           std::span<const SampleChanges> errors, double reflectance) {
  std::vector<Geometry> geometries;
  for (const Sample& sample : samples) geometries.push_back(sample.geometry);
  const bool is_f11 = feeds_f11(columns.isotropic());
  const Eigen::VectorXd weights =
      reading_weights(at.law, geometries,
                      is_f11 && at.law.relative ? first_f11(at.f11, columns.mapping(), geometries) : Eigen::VectorXd());
  const MatrixXd rows = columns.read_at(geometries);
  MatrixXd effects(rows.rows(), static_cast<Index>(errors.size()));
  for (Index row = 0; const Element& element : columns.read())
    for (std::size_t s = 0; s < samples.size(); ++s, ++row) {
      const double w = weights(static_cast<Index>(s));
      for (std::size_t k = 0; k < errors.size(); ++k)
        effects(row, static_cast<Index>(k)) =
            w * w * errors[k][s].elements[element.index()] / (is_f11 ? reflectance : 1);
    }
  return rows.transpose() * effects;
}

/// The posterior of a model of one wavelength with more errors that all its samples share: what one of them does to the
/// coefficients is V XᵀW² D / s².
Posterior with_shared_errors(const Model& model, std::span<const Sample> samples,
                             std::span<const SampleChanges> errors) {
  PosteriorData data = model.posterior->data();
  if (data.wavelengths.size() != 1) throw std::invalid_argument("the model is of more than one wavelength");
  PosteriorAt& at = data.wavelengths.front();
  const double reflectance = model.reflectance.at(at.wavelength);
  for (std::size_t k = 0; k < errors.size(); ++k) data.errors.push_back({"instrument", 1});
  for (std::size_t b = 0; b < at.blocks.size(); ++b) {
    const MixedColumns columns(model.posterior->blocks()[b], data.mapping, data.unread);
    const MatrixXd effects = covariance_of_all(data, at, at.blocks[b], columns).topRows(columns.isotropic_count()) *
                             weighted_products(columns, at, samples, errors, reflectance) / at.blocks[b].noise_variance;
    const Eigen::MatrixXf shared = effects.cast<float>();
    at.blocks[b].shared.insert(at.blocks[b].shared.end(), shared.data(), shared.data() + shared.size());
  }
  return Posterior(std::move(data));
}

/// In one sample at least.
Elements missing(std::span<const Sample> samples) {
  Elements result;
  for (const Sample& sample : samples) result |= not_measured(sample);
  return result;
}

}  // namespace

std::vector<SampleChanges> instrument_errors(const Reduction& reduction, std::span<const Sample> samples) {
  std::vector<SampleChanges> result;
  if (const Elements unknown = missing(samples); unknown.any())
    throw std::invalid_argument("missing in some samples or all: " + element_names(unknown) +
                                "; what errors of the instrument do is known of whole matrices only");
  for (const Sample& sample : samples) {
    const Mueller m = change_frame(sample.normalized, sample.geometry, Frame::xy, Frame::scattering_plane);
    const std::vector<Mueller> changes = reduction.errors(m);
    result.resize(changes.size());
    for (std::size_t k = 0; k < changes.size(); ++k) {
      const double relative = changes[k](0, 0);  // M11 is 1
      Mueller change = change_frame(changes[k] - relative * m, sample.geometry, Frame::scattering_plane, Frame::xy);
      change(0, 0) = relative * sample.f11;
      result[k].push_back(change);
    }
  }
  return result;
}

void add_common_errors(Model& model, std::span<const Sample> samples, std::span<const SampleChanges> errors,
                       std::span<const Mueller> weights) {
  require_fitting(model, samples, errors, weights);
  const PreparedModel values = prepare(model, samples[0].wavelength);
  const PreparedUncertainty slopes = prepare_uncertainty(model, samples[0].wavelength);
  const double reflectance = model.reflectance.at(samples[0].wavelength);
  std::vector<Normal> normals = empty_normals(model, errors.size());
  std::vector<Mueller> changes(errors.size());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const double turn = turns(model) ? -samples[s].geometry.incident.phi : 0;
    for (std::size_t k = 0; k < errors.size(); ++k) changes[k] = turned(errors[k][s], turn);
    const Geometry geometry = turn == 0 ? samples[s].geometry : at_zero_azimuth(samples[s]).geometry;
    const std::array<Units, 2> units{{{reflectance, reflectance}, {values.evaluate(geometry)(0, 0), 1}}};
    add_sample(normals, model, slopes.gradient(geometry), units, changes, weights.empty() ? nullptr : &weights[s]);
  }
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Index size = normals[b].matrix.rows();
    const MatrixXd whole = normals[b].matrix.selfadjointView<Eigen::Lower>();
    const MatrixXd moved = dense::shortest_least_squares(whole, normals[b].vectors);
    const MatrixXd added = moved * moved.transpose();
    Eigen::Map<MatrixXd>(model.blocks[b].covariance.data(), size, size) += (added + added.transpose()) / 2;
  }
}

void require_measured_by(std::span<const Sample> samples, const Calibration& instrument, const std::string& name) {
  if (instrument.covariance.empty()) throw std::invalid_argument(name + ": a linear calibration, without a covariance");
  for (const Sample& sample : samples)
    if (!same_wavelength(sample.wavelength, instrument.wavelength))
      throw std::invalid_argument(name + ": of " + rounded(nanometres(instrument.wavelength), 10) +
                                  " nm, but there are data at " + rounded(nanometres(sample.wavelength), 10) + " nm");
}

void add_instrument(FitResult& fitted, std::span<const Sample> samples, const Calibration& instrument,
                    const std::string& name) {
  require_measured_by(samples, instrument, name);
  const Reduction reduction(instrument.polarimeter, instrument.covariance);
  if (fitted.model.posterior) {
    fitted.model.posterior = with_shared_errors(fitted.model, samples, instrument_errors(reduction, samples));
    fitted.model.provenance["instrument"] = name;
    return;
  }
  require_covariance(fitted);
  add_common_errors(fitted.model, samples, instrument_errors(reduction, samples), fitted.sample_weights);
  fitted.model.provenance["instrument"] = name;
}

}  // namespace mmbrdf
