// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/mixed/sample_traits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mixed/directions.hpp"
#include "mixed/readings.hpp"
#include "mmbrdf/mixed/plan.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t directions = 300;         // enough for two digits
constexpr double noticeable = 5e-4;             // of what reciprocity forbids, sr⁻¹
constexpr double worth_turning = 1.5;           // factor in u(f11)
constexpr double noticeable_anisotropy = 1e-3;  // sr⁻¹ or without unit

SampleTraits traits_of(const MixedColumns& columns, const BlockPosterior& p) {
  const Prior prior = prior_of(columns);
  const VectorXd v = prior.variances(
      Eigen::Map<const VectorXd>(p.hyperparameters.data(), static_cast<Index>(p.hyperparameters.size())));
  const MatrixXd rows = columns.at(spread_directions(directions));
  SampleTraits result{columns.isotropic().name, std::sqrt(p.noise_variance), {}, 0};
  VectorXd forbidden = VectorXd::Zero(rows.rows());
  Index j = columns.isotropic_count();
  for (const FreeMode& mode : columns.free()) {
    if (mode.kind == FreeMode::Kind::harmonic)
      result.anisotropy[static_cast<std::size_t>(mode.harmonic - 1)] +=
          v(j) * rows.col(j).squaredNorm() / static_cast<double>(rows.rows());
    if (mode.kind == FreeMode::Kind::nonreciprocal)
      forbidden +=
          static_cast<double>(p.free_mean[static_cast<std::size_t>(j - columns.isotropic_count())]) * rows.col(j);
    ++j;
  }
  for (double& a : result.anisotropy) a = std::sqrt(a);
  result.nonreciprocal = std::sqrt(forbidden.squaredNorm() / static_cast<double>(rows.rows()));
  return result;
}

std::string two_digits(double u) { return to_place_of(u, u); }

std::string of_noise(const std::vector<SampleTraits>& blocks, bool relative) {
  double others = 0;
  for (const SampleTraits& block : blocks)
    if (block.block != "11") others = std::max(others, block.noise);
  return "noise " + two_digits(blocks.front().noise) +
         (relative ? " of f11, relative, " : " of f11 / reflectance, the same everywhere, ") +
         (blocks.size() > 1 ? two_digits(others) + " of the other elements, " : "") + "at normal directions";
}

/// Nothing for a sample that is as good as isotropic.
std::string of_anisotropy(const std::vector<SampleTraits>& blocks) {
  std::string list;
  for (const SampleTraits& block : blocks)
    if (block.anisotropy[0] > noticeable_anisotropy)
      list += (list.empty() ? "" : ", ") + two_digits(block.anisotropy[0]) + " in " +
              (block.block == "11" ? "f11 (sr^-1)" : block.block);
  return list.empty() ? "" : "the sample is not isotropic: once per turn " + list;
}

bool has_one_azimuth(const std::vector<ReadingDirections>& readings) {
  constexpr double tolerance = 1e-3;
  for (const ReadingDirections& one : readings) {
    const double difference = one.angles[1] - readings.front().angles[1];
    if (one.angles[0] > tolerance && std::abs(std::remainder(difference, 2 * std::numbers::pi)) > tolerance)
      return false;
  }
  return true;
}

/// What every second reading with the sample turned by half a turn would have been worth.
std::string of_turning(const Posterior& posterior, std::size_t wavelength) {
  const PosteriorAt& at = posterior.data().wavelengths[wavelength];
  if (!at.blocks.front().factor.empty() || !has_one_azimuth(posterior.data().readings[at.readings])) return "";
  std::vector<Geometry> as_is, turned;
  for (const auto& [angles, count] : posterior.data().readings[at.readings])
    for (std::uint32_t i = 0; i < count; ++i) {
      as_is.push_back({{angles[0], angles[1]}, {angles[2], angles[3]}});
      turned.push_back(as_is.back());
      const double turn = as_is.size() % 2 == 0 ? std::numbers::pi : 0;
      turned.back().incident.phi += turn;
      turned.back().reflected.phi += turn;
    }
  const VarianceComponents components = components_of(posterior, at.wavelength);
  const PlanTarget f11[] = {{PlanTarget::Kind::block, 0, {}}};
  const double now = expected_uncertainties(components, as_is, f11)[0],
               then = expected_uncertainties(components, turned, f11)[0];
  if (now < worth_turning * then) return "";
  return "all readings were taken at one azimuth, and the isotropic mean carries the anisotropy; with the sample "
         "turned "
         "by 180 degrees for every second one u(f11) would have been " +
         two_digits(then) + " in place of " + two_digits(now) + " sr^-1 (mmbrdf plan)";
}

std::string of_declared(const std::vector<SharedError>& errors) {
  std::string list;
  for (const auto& [name, size] : errors)
    if (size > 0 && name.starts_with("declared "))
      list += (list.empty() ? "" : ", ") + name.substr(9) + " " +
              (name.ends_with("arm") ? shortest(in_degrees(size)) + " degrees" : shortest(100 * size) + " %");
  return list.empty() ? "errors of the scale and of the arms are not in u: no single series can show them (--declare)"
                      : "declared, not measured: " + list;
}

}  // namespace

std::vector<SampleTraits> sample_traits(const Posterior& posterior, std::size_t wavelength) {
  std::vector<SampleTraits> result;
  for (std::size_t b = 0; b < posterior.blocks().size(); ++b)
    result.push_back(traits_of(MixedColumns(posterior.blocks()[b], posterior.data().mapping),
                               posterior.data().wavelengths.at(wavelength).blocks[b]));
  return result;
}

std::vector<std::string> described_sample(const Posterior& posterior) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < posterior.data().wavelengths.size(); ++k) {
    const std::vector<SampleTraits> blocks = sample_traits(posterior, k);
    const std::string where = shortest(in_nanometres(posterior.data().wavelengths[k].wavelength)) + " nm: ";
    lines.push_back(where + of_noise(blocks, posterior.data().wavelengths[k].law.relative));
    if (const std::string text = of_anisotropy(blocks); !text.empty()) lines.push_back(where + text);
    if (blocks.front().nonreciprocal > noticeable)
      lines.push_back(where + "source and receiver are not interchangeable: a part of f11 of " +
                      two_digits(blocks.front().nonreciprocal) + " sr^-1 is in no reciprocal model");
  }
  if (const std::string text = of_turning(posterior, 0); !text.empty()) lines.push_back(text);
  lines.push_back(of_declared(posterior.data().errors));
  return lines;
}

}  // namespace mmbrdf
