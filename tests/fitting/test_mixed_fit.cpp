// SPDX-License-Identifier: BSD-3-Clause
// The mixed model: of invented readings against sums over each, of the published measurements against an independent
// implementation in numpy (tests/data).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "given/checkout.hpp"
#include "given/first_pass.hpp"
#include "given/published_samples.hpp"
#include "mixed/block_fit.hpp"
#include "mixed/readings.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "numerics/eigen_index.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::json;

const char* const grid = "PTFE.data.csv";
const char* const random_set = "PTFE.data.random.csv";

json golden() {
  std::ifstream file(in_checkout("tests/data/mixed_model.json"));
  return json::parse(file);
}

/// Blocks as the reference names them, with the order of its elements.
struct Named {
  const char* name;
  std::vector<int> elements;  // 11, 12, …
};
const std::vector<Named> named = {
    {"11", {11}}, {"g", {12, 13, 21, 31}}, {"14", {14, 41}}, {"uv", {22, 33, 32, 23}}, {"h", {42, 43, 24, 34}},
    {"44", {44}}};

std::vector<Geometry> geometries(const json& list) {
  std::vector<Geometry> result;
  for (const json& g : list) result.push_back({direction_from_degrees(g[0], g[1]), direction_from_degrees(g[2], g[3])});
  return result;
}

/// Rows of all isotropic modes at some geometries, with elements in the order of the reference.
MatrixXd rows(const MixedColumns& columns, const Named& block, const std::vector<Geometry>& at) {
  const MatrixXd ours = columns.isotropic_at(at);
  const auto count = static_cast<Index>(at.size());
  MatrixXd result(ours.rows(), ours.cols());
  for (Index e = 0; e < columns.elements(); ++e) {
    const int wanted = block.elements[static_cast<std::size_t>(e)];
    const auto found = std::ranges::find(columns.isotropic().elements, Element{wanted / 10 - 1, wanted % 10 - 1});
    result.middleRows(e * count, count) =
        ours.middleRows((found - columns.isotropic().elements.begin()) * count, count);
  }
  return result;
}

VectorXd numbers(const json& list) {
  std::vector<double> flat;
  for (const json& item : list)
    if (item.is_array())
      for (const json& x : item) flat.push_back(x);
    else
      flat.push_back(item);
  return Eigen::Map<VectorXd>(flat.data(), static_cast<Index>(flat.size()));
}

/// Largest |difference| less what the last digit that is given hides, over the scale of each.
double farthest(const VectorXd& found, const VectorXd& expected, const VectorXd& scale, double digit) {
  return ((found - expected).cwiseAbs().array() - digit).cwiseMax(0).cwiseQuotient(scale.array()).maxCoeff();
}
double farthest(const VectorXd& found, const VectorXd& expected, double digit) {
  return farthest(found, expected, expected.cwiseAbs().cwiseMax(digit), digit);
}

struct OfBlock {
  MixedColumns columns;
  Gram gram;
  Block evaluated;
};

std::vector<Sample> samples_of(const char* file) {
  return at_wavelengths(read_samples(published(file)), std::array{0.532});
}

std::vector<OfBlock> sums(const std::vector<Sample>& samples) {
  const Basis basis;
  const FirstPass first = first_pass(samples, basis, {});
  const std::vector<Block> evaluated = blocks(basis.family, basis.orders),
                           behind = blocks(Family::isotropic, generous(basis.orders));
  std::vector<OfBlock> result;
  for (std::size_t b = 0; b < behind.size(); ++b) {
    const MixedColumns columns(behind[b], basis.mapping);
    result.push_back({columns, sums_of(columns, samples, first), evaluated[b]});
  }
  return result;
}

/// What a fit says at the golden geometries.
struct Said {
  VectorXd value, mean, posterior, projection;
  MatrixXd shared;  // a column for each declared error of size 1
};
Said said(const OfBlock& block, const BlockFit& fit, const MatrixXd& h) {
  const auto n = static_cast<Index>(fit.posterior.mean.size());
  const std::vector<Index> kept = columns_of(block.evaluated, block.columns.isotropic());
  Said result;
  result.value =
      h(Eigen::all, kept) * Eigen::Map<const VectorXd>(fit.coefficients.data(), static_cast<Index>(kept.size()));
  result.mean = h * Eigen::Map<const VectorXd>(fit.posterior.mean.data(), n);
  result.posterior = (h * fit.covariance).cwiseProduct(h).rowwise().sum().cwiseMax(0).cwiseSqrt();
  result.projection = (result.value - result.mean).cwiseAbs();
  result.shared = h * Eigen::Map<const Eigen::MatrixXf>(fit.posterior.shared.data(), n, 3).cast<double>();
  return result;
}

TEST(MixedFit, AgreesWithTheReferenceAtFixedVariances) {
  if (published(grid).empty()) GTEST_SKIP() << absent(grid);
  const json all = golden();
  const std::vector<Geometry> at = geometries(all["geometries"]);
  const std::vector<OfBlock> blocks = sums(samples_of(grid));
  for (std::size_t b = 0; b < named.size(); ++b) {
    const json& expected = all["fixed"][named[b].name];
    const OfBlock& block = blocks[b];
    const Prior prior = prior_of(block.columns);
    const Parts parts = parts_of(block.gram.g, block.columns.calibration_count());
    LogVariances variances(prior.mean.size() + 1);
    variances << prior.mean, std::log(3e-5);
    const Evidence found = evidence(block.gram, parts, prior, variances);
    SCOPED_TRACE(named[b].name);
    EXPECT_NEAR(found.alone / expected["log_evidence"].get<double>(), 1, 1e-8);
    EXPECT_EQ(block.gram.n, expected["n"]);
    EXPECT_NEAR(block.gram.yy, expected["yy"], 1e-6);
    VectorXd gradient(variances.size());  // by name: theirs come in another order
    std::map<std::string, std::string> theirs{{"free_slope", "free slope"}, {"calibration", "cal"}};
    const std::vector<std::string> names = hyperparameter_names(block.columns.isotropic());
    for (Index h = 0; h < prior.mean.size(); ++h) {
      const std::string& name = names[static_cast<std::size_t>(h)];
      gradient(h) = expected["gradient"][theirs.contains(name) ? theirs[name] : name];
    }
    gradient(prior.mean.size()) = expected["gradient"]["ln s2"];
    EXPECT_LT(farthest(found.gradient, gradient, 1e-5), 1e-5);
    const Said here = said(block, fit_block_at(block.columns, block.gram, block.evaluated, variances),
                           rows(block.columns, named[b], at));
    const VectorXd u = numbers(expected["u_posterior"]);
    EXPECT_LT(farthest(here.mean, numbers(expected["mean"]), 1e-8), 1e-6);
    EXPECT_LT(farthest(here.value, numbers(expected["value"]), 1e-8), 1e-6);
    EXPECT_LT(farthest(here.posterior, u, 1e-8), 1e-5);
    const std::array<const char*, 3> errors{"scale", "source arm", "receiver arm"};
    for (Index e = 0; e < 3; ++e) {
      const json::const_iterator effect = expected["declared"].find(errors[static_cast<std::size_t>(e)]);
      if (effect == expected["declared"].end()) continue;
      EXPECT_LT(farthest(here.shared.col(e), numbers(*effect), 1e-6), 1e-5) << effect.key();
    }
  }
}

void expect_estimate(const char* file, const char* series) {
  const json all = golden();
  const std::vector<Geometry> at = geometries(all["geometries"]);
  const std::vector<OfBlock> blocks = sums(samples_of(file));
  for (std::size_t b = 0; b < named.size(); ++b) {
    SCOPED_TRACE(std::string(series) + " " + named[b].name);
    const json& expected = all["estimated"][named[b].name][series];
    const OfBlock& block = blocks[b];
    EXPECT_EQ(block.columns.isotropic_count(), expected["columns"][0]);
    EXPECT_EQ(block.columns.size(), std::accumulate(expected["columns"].begin(), expected["columns"].end(), 0,
                                                    [](int sum, const json& x) { return sum + x.get<int>(); }));
    const BlockFit fit = fit_block(block.columns, block.gram, block.evaluated);
    EXPECT_GT(fit.posterior.evidence, expected["objective"].get<double>() - 0.05);
    EXPECT_NEAR(std::sqrt(fit.posterior.noise_variance) / expected["noise"].get<double>(), 1, 1e-3);
    EXPECT_LT(fit.evaluations, 40);
    const Said here = said(block, fit, rows(block.columns, named[b], at));
    const VectorXd u = numbers(expected["u"]), posterior = numbers(expected["posterior"]);
    EXPECT_LT(farthest(here.mean, numbers(expected["mean"]), u.cwiseMax(1e-6), 1e-6), 0.03);
    EXPECT_LT(farthest(here.value, numbers(expected["value"]), u.cwiseMax(1e-6), 1e-6), 0.03);
    EXPECT_LT(farthest(here.posterior, posterior, 1e-6), 0.02);
    EXPECT_LT(farthest(here.projection, numbers(expected["projection"]), 1e-5), 0.03 + 1e-3);
    const VectorXd arms = here.shared.rightCols(2).rowwise().norm() * radians(0.5);
    EXPECT_LT(farthest(arms, numbers(expected["declared arms"]), 1e-5), 0.03);
  }
}

TEST(MixedFit, FindsTheVariancesOfTheReferenceForThePublishedGrid) {
  if (published(grid).empty()) GTEST_SKIP() << absent(grid);
  expect_estimate(grid, "grid");
}

TEST(MixedFit, FindsTheVariancesOfTheReferenceForThePublishedRandomSet) {
  if (published(random_set).empty()) GTEST_SKIP() << absent(random_set);
  expect_estimate(random_set, "random");
}

TEST(MixedFit, SumsOfPartsOfASeriesAddUp) {
  if (published(grid).empty()) GTEST_SKIP() << absent(grid);
  const std::vector<Sample> samples = samples_of(grid);
  const Basis basis;
  const FirstPass first = first_pass(samples, basis, {});
  const MixedColumns columns(blocks(Family::isotropic, generous_orders).front(), basis.mapping);
  const std::span<const Sample> all(samples);
  const Gram whole = sums_of(columns, all, first);
  Gram merged = sums_of(columns, all.first(700), first);
  merged.merge(sums_of(columns, all.subspan(700), first));
  const Block evaluated = blocks(basis.family, basis.orders).front();
  const BlockPosterior a = fit_block(columns, whole, evaluated).posterior,
                       b = fit_block(columns, merged, evaluated).posterior;
  EXPECT_NEAR(a.evidence, b.evidence, 1e-4);  // the top is flat: rounding ends the search elsewhere
  for (std::size_t h = 0; h < a.hyperparameters.size(); ++h)
    EXPECT_NEAR(a.hyperparameters[h], b.hyperparameters[h], 1e-3);
}

std::vector<Sample> simulated(int count) {
  return simulate(material("ptfe-532"), std::array{0.532}, random_geometries(count, 3), 0.006, 3);
}

double f11_of(const PreparedModel& model, Geometry g, double source, double receiver) {
  g.incident.theta += source;
  g.reflected.theta += receiver;
  return model.f11(g);
}

// Theory 8.1 and 8.4. Looked at in the plane of incidence, the sample sees both arms turn from the source to the receiver:
// the one rises as the other sinks. 1e-6: differences of 1e-5 of the arms.
TEST(MixedFit, HasTheSumsOfWeighedReadingsAndOfErrorsThatTheyShare) {
  std::vector<Sample> samples = simulated(60);
  for (Sample& sample : samples) sample.geometry.reflected.phi = sample.geometry.incident.phi + std::numbers::pi;
  FirstPass first = first_pass(samples, {}, {});
  first.law = {2, 0.5, true};
  const PreparedModel model = prepare(first.model, 0.532);
  const MixedColumns seventh(blocks(Family::isotropic, {first_order, 0}).front(), DiscMapping::lambert);
  std::vector<Geometry> at;
  for (const Sample& sample : samples) at.push_back(sample.geometry);
  const VectorXd f11 = seventh.isotropic_at(at) * Eigen::Map<const VectorXd>(first.f11.data(), index(first.f11.size()));
  for (const std::size_t b : {0U, 1U}) {
    const MixedColumns columns(blocks(Family::isotropic, {3, 2})[b], DiscMapping::lambert);
    const MatrixXd x = columns.at(at);
    VectorXd w2(x.rows()), y(x.rows());
    MatrixXd d = MatrixXd::Zero(x.rows(), 3);
    for (Index row = 0; row < x.rows(); ++row) {
      const auto s = static_cast<std::size_t>(row % index(at.size()));
      const Element& element = columns.isotropic().elements[static_cast<std::size_t>(row) / at.size()];
      w2(row) = std::sqrt(std::cos(at[s].reflected.theta)) / std::pow(std::cos(at[s].incident.theta), 2);
      y(row) = b == 0 ? samples[s].f11 : samples[s].normalized.elements[element.index()];
      if (b > 0) continue;
      w2(row) /= std::pow(f11(row), 2);
      constexpr double step = 1e-5;
      d(row, 0) = model.f11(at[s]);
      d(row, 1) = -(f11_of(model, at[s], step, 0) - f11_of(model, at[s], -step, 0)) / (2 * step);
      d(row, 2) = (f11_of(model, at[s], 0, step) - f11_of(model, at[s], 0, -step)) / (2 * step);
    }
    const Gram found = sums_of(columns, samples, first);
    const MatrixXd g = x.transpose() * w2.asDiagonal() * x, errors = x.transpose() * w2.asDiagonal() * d;
    const VectorXd z = x.transpose() * w2.cwiseProduct(y);
    const double yy = w2.dot(y.cwiseAbs2());
    EXPECT_EQ(found.n, x.rows());
    EXPECT_NEAR(found.yy / yy, 1, 1e-12);
    EXPECT_LT((found.z - z).cwiseAbs().maxCoeff(), 1e-12 * z.cwiseAbs().maxCoeff());
    EXPECT_LT((MatrixXd(found.g.selfadjointView<Eigen::Lower>()) - g).cwiseAbs().maxCoeff(), 1e-12 * g.maxCoeff());
    if (b > 0) {
      EXPECT_EQ(found.d.col(0).cwiseAbs().maxCoeff(), 0);  // a scale is none of normalised elements
      continue;
    }
    for (Index e = 0; e < 3; ++e)
      EXPECT_LT((found.d.col(e) - errors.col(e)).cwiseAbs().maxCoeff(), 1e-6 * errors.col(e).cwiseAbs().maxCoeff())
          << e;
  }
}

// Theory 8.3, round 2: noise is relative where the least f11 of the first fit exceeds the typical size of what it leaves.
// Of pairs that are as much above it as below, the fit is that of their means.
TEST(MixedFit, TakesNoiseForRelativeOnlyWhereF11StandsAboveIt) {
  std::vector<Sample> samples = simulated(100);
  EXPECT_TRUE(first_pass(samples, {}, {}).law.relative);
  const std::vector<Sample> again = samples;
  samples.insert(samples.end(), again.begin(), again.end());
  std::vector<Geometry> at;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    samples[s].f11 += s < 100 ? 0.5 : -0.5;
    at.push_back(samples[s].geometry);
  }
  const FirstPass noisy = first_pass(samples, {}, {});
  EXPECT_FALSE(noisy.law.relative);
  EXPECT_GT(first_f11(noisy.f11, DiscMapping::lambert, at).minCoeff(), 0);
}

// f11 and the reflectance in other units are the same sample. 1e-4, 1e-5: the top of the evidence is flat, and rounding
// ends the search elsewhere.
TEST(MixedFit, IsTheSameInUnitsOfAnotherReflectance) {
  constexpr double unit = 7;
  std::vector<Sample> samples = simulated(60);
  for (Sample& sample : samples)  // f11 alone: one block, in little time
    for (std::size_t e = 1; e < 16; ++e) sample.normalized.elements[e] = std::nan("");
  std::vector<Sample> others = samples;
  for (Sample& sample : others) sample.f11 *= unit;
  FitOptions options, scaled;
  options.declared = scaled.declared = {0.01, 0.01, 0.01};
  options.reflectance = ReflectanceTable{{0.532}, {1}};
  scaled.reflectance = ReflectanceTable{{0.532}, {unit}};
  const PosteriorAt a = fit_sample(samples, {}, options).model.posterior->data().wavelengths[0],
                    b = fit_sample(others, {}, scaled).model.posterior->data().wavelengths[0];
  for (std::size_t j = 0; j < a.f11.size(); ++j) EXPECT_NEAR(b.f11[j], a.f11[j], 1e-9 * std::abs(a.f11[0]));
  const BlockPosterior &p = a.blocks[0], &q = b.blocks[0];
  EXPECT_NEAR(q.noise_variance / p.noise_variance, 1, 1e-4);
  for (std::size_t j = 0; j < p.mean.size(); ++j) EXPECT_NEAR(q.mean[j], p.mean[j], 1e-4 * std::abs(p.mean[0])) << j;
  for (std::size_t j = 0; j < p.shared.size(); ++j)
    EXPECT_NEAR(q.shared[j], p.shared[j], 1e-4F * std::abs(p.shared[0])) << j;
}

/// At some azimuth of the receiver each, from one on.
std::vector<Sample> directions(std::size_t from, std::size_t count) {
  std::vector<Sample> result(count);
  for (Sample& sample : result) sample.geometry = {{0.5, 0}, {0.5, 1e-4 * static_cast<double>(from++)}};
  return result;
}

TEST(MixedFit, CountsDirectionsUntilThereAreTooMany) {
  DirectionCounts all, first, second, third;
  first.add(directions(0, 5000));
  second.add(directions(4000, 5000));
  all.add(directions(0, 5000));
  all.add(directions(4000, 5000));
  first.merge(second);
  EXPECT_EQ(first.rising(), all.rising());
  ASSERT_EQ(all.rising().size(), 9000);
  EXPECT_EQ(all.rising()[4500].count, 2);
  EXPECT_FALSE(all.too_many());
  third.add(directions(9000, 1));
  third.merge(all);
  all.add(directions(9000, 1));
  for (const DirectionCounts& one : {third, all}) {
    EXPECT_TRUE(one.too_many());
    EXPECT_TRUE(one.rising().empty());
  }
}

TEST(MixedFit, OfWhatIsNoNumberIsRefused) {
  const MixedColumns columns(blocks(Family::isotropic, {3, 2}).front(), DiscMapping::lambert);
  Gram gram(columns.size(), 0);
  gram.g.diagonal().setConstant(1);
  gram.g(1, 0) = std::nan("");
  gram.yy = 10;
  gram.n = 10;
  Parts together{{std::vector<Index>(static_cast<std::size_t>(columns.size()))}, {}};
  std::iota(together.columns[0].begin(), together.columns[0].end(), Index{0});
  const Prior prior = prior_of(columns);
  LogVariances variances(prior.mean.size() + 1);
  variances << prior.mean, 0;
  EXPECT_FALSE(std::isfinite(evidence(gram, together, prior, variances).value));
  EXPECT_THROW(estimate(gram, together, prior, 1), std::invalid_argument);
}

}  // namespace
}  // namespace mmbrdf
