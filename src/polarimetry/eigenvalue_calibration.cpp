// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/eigenvalue_calibration.hpp"

// With B0 that of the empty beam, C_i = B0⁻¹ B_i = W⁻¹ M_i W has the eigenvalues of M_i, from which M_i is known but
// for the polarizer's azimuth; then M_i W − W C_i = 0 is linear in W. With more than four states all is first projected
// to the four directions that B0 spans. The stacked equations are solved by their singular values: the eigenvalues of
// their normal matrix have a floor of 1e-16, which hides errors of the azimuth below 1e-8.
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "numerics/dense.hpp"
#include "numerics/golden_section.hpp"
#include "polarimetry/wafer_signs.hpp"
#include "text/numbers.hpp"

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Complex = std::complex<double>;
using Block = Eigen::Matrix<double, 16, 16>;

/// The readings of the empty beam, and the four directions that they span.
struct EmptyBeam {
  MatrixXd analyzer;   ///< U, analysis states × 4
  MatrixXd generator;  ///< V, generator states × 4
  Matrix4d projected;  ///< Uᵀ B0 V
};

/// Gains of single measurements are taken out, and their mean is kept.
EmptyBeam empty_beam(std::span<const Reference> references, const CalibrationOptions& options) {
  MatrixXd shape = MatrixXd::Zero(index(options.analyzer_states), index(options.generator_states));
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    if (references[i].kind != ReferenceKind::empty) continue;
    const auto b = matrix(references[i].readings, options);
    if (!(b.sum() > 0))
      throw std::invalid_argument("reference " + std::to_string(i + 1) +
                                  ": the readings of the empty beam are not positive");
    shape += b / b.sum();
    sum += b.sum();
    ++count;
  }
  const MatrixXd mean = (sum / count) * (shape / count);
  const dense::Svd svd = dense::thin_svd(mean);
  if (!(svd.s(3) > 1e-9 * svd.s(0)))
    throw std::invalid_argument(
        "the readings of the empty beam have fewer than four independent states: generator and analyzer need four "
        "each");
  EmptyBeam result{svd.u.leftCols(4), svd.v.leftCols(4), {}};
  result.projected = svd.s.head(4).asDiagonal();
  return result;
}

/// C of a reference.
Matrix4d similar(const EmptyBeam& empty, std::span<const double> readings, const CalibrationOptions& options) {
  const Matrix4d projected = empty.analyzer.transpose() * matrix(readings, options) * empty.generator;
  return empty.projected.diagonal().cwiseInverse().asDiagonal() * projected;
}

/// Two that are nearly real, the larger first, and a nearly conjugate pair, of C for a diattenuator-retarder.
struct Spectrum {
  double larger = 0, smaller = 0;
  Complex pair;
};

Spectrum spectrum(const Matrix4d& c) {
  const Eigen::VectorXcd l = dense::complex_eigenvalues(c);
  const double scale = l.cwiseAbs().maxCoeff();
  constexpr std::array<std::array<int, 4>, 6> pairings{
      {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};
  Spectrum best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c1, c2] : pairings) {
    const double misfit = std::abs(l(a).imag()) + std::abs(l(b).imag()) + std::abs(l(c1) - std::conj(l(c2))) +
                          std::abs(l(a) * l(b) - (l(c1) * l(c2)).real()) / scale;
    if (misfit >= least) continue;
    least = misfit;
    const Complex pair = (l(c1) + std::conj(l(c2))) / 2.;
    best = {std::max(l(a).real(), l(b).real()), std::min(l(a).real(), l(b).real()), pair};
  }
  return best;
}

/// A wafer as its eigenvalues tell it: psi up to 45 degrees, delta positive.
DiattenuatorRetarder unsigned_wafer(const Spectrum& s) {
  const double smaller = std::max(s.smaller, 0.0);
  return {(s.larger + s.smaller) / 2, std::atan(std::sqrt(smaller / s.larger)), std::abs(std::arg(s.pair))};
}

/// Its axes and the sign of its retardance are known; that it has no diattenuation is refined.
DiattenuatorRetarder known_retarder(const DiattenuatorRetarder& seen, const Reference& reference) {
  return {seen.tau, std::numbers::pi / 4, reference.delta_sign < 0 ? -seen.delta : seen.delta};
}

void find_wafers(Unknowns& unknowns, std::span<const Reference> references, std::span<const Matrix4d> c,
                 const CalibrationOptions& options) {
  std::vector<SeenWafer> wafers;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const bool wafer = references[i].kind == ReferenceKind::wafer;
    if (!wafer && references[i].kind != ReferenceKind::retarder) continue;
    const Spectrum s = spectrum(c[i]);
    if (!(s.larger > 0) || !std::isfinite(s.larger))
      throw std::invalid_argument("reference " + std::to_string(i + 1) +
                                  (wafer ? ": a wafer that reflects nothing" : ": a retarder that passes nothing"));
    unknowns.elements[i] = unsigned_wafer(s);
    if (wafer)
      wafers.push_back({i, unknowns.elements[i], false, false});
    else
      unknowns.elements[i] = known_retarder(unknowns.elements[i], references[i]);
  }
  give_signs(wafers, references, options);
  for (const SeenWafer& wafer : wafers) unknowns.elements[wafer.reference] = wafer.element;
}

/// Rows of M W − W C = 0 for vec(W), column by column, divided by M11.
Block equations(const Matrix4d& m, const Matrix4d& c) {
  Block h = Block::Zero();
  for (Index column = 0; column < 4; ++column) {
    h.block<4, 4>(4 * column, 4 * column) += m;
    for (Index other = 0; other < 4; ++other)
      h.block<4, 4>(4 * column, 4 * other).diagonal().array() -= c(other, column);
  }
  return h / m(0, 0);
}

/// The stacked equations, as a function of the azimuth of the polarizer.
class Stack {
 public:
  Stack(std::span<const Reference> references, std::span<const Matrix4d> c, const Unknowns& unknowns,
        const CalibrationOptions& options)
      : references_(references), c_(c), unknowns_(unknowns), options_(options) {
    MatrixXd wafers(0, 16);
    for (std::size_t i = 0; i < references.size(); ++i) {
      if (references[i].kind == ReferenceKind::polarizer) polarizers_.push_back(i);
      if (references[i].kind != ReferenceKind::wafer && references[i].kind != ReferenceKind::retarder) continue;
      wafers.conservativeResize(wafers.rows() + 16, 16);
      wafers.bottomRows(16) = equations(matrix(reference_matrix(unknowns, references, i, options)), c[i]);
    }
    triangle_ = dense::triangle(wafers);
  }

  /// Without U.
  dense::Svd at(double offset) const {
    MatrixXd rows(16 + 16 * index(polarizers_.size()), 16);
    rows.topRows(16) = triangle_;
    Index next = 16;
    for (const std::size_t i : polarizers_) {
      const double azimuth = offset + options_.dial_sense * references_[i].angle;
      const Mueller m = unknowns_.gains[i] * leaky_polarizer(azimuth, unknowns_.leak_real, unknowns_.leak_imaginary);
      rows.middleRows(next, 16) = equations(matrix(m), c_[i]);
      next += 16;
    }
    return dense::right_svd(dense::triangle(rows));
  }

 private:
  std::span<const Reference> references_;
  std::span<const Matrix4d> c_;
  const Unknowns& unknowns_;
  const CalibrationOptions& options_;
  std::vector<std::size_t> polarizers_;
  MatrixXd triangle_;
};

double ratio(const dense::Svd& svd) { return svd.s(15) / svd.s(14); }

/// Without references that tie S4 to S2 and S3, the equations are solved by states of S4 alone.
void require_unique(const VectorXd& s, const Matrix4d& w) {
  const VectorXd parts = dense::singular_values(w);
  if (!(parts(3) > 1e-6 * parts(0)))
    throw std::invalid_argument(
        "the references leave more than one instrument: nothing ties the components of its states to each other; add "
        "dial angles of the polarizer or wafers that turn linear into elliptic polarization");
  if (!(s(14) / s(0) > least_identifiability))
    throw std::invalid_argument("the references leave more than one instrument: s15/s1 is " + shortest(s(14) / s(0)) +
                                ", must be above " + shortest(least_identifiability) +
                                "; add dial angles of the polarizer or angles of incidence");
}

void find_states(Unknowns& unknowns, const EmptyBeam& empty, const dense::Svd& svd) {
  const VectorXd& s = svd.s;
  unknowns.singular_ratio = ratio(svd);
  unknowns.identifiability = s(14) / s(0);
  Matrix4d w = Eigen::Map<const Matrix4d>(svd.v.col(15).data());
  require_unique(s, w);
  unknowns.generator = w * empty.generator.transpose();
  const double scale = unknowns.generator.row(0).mean();
  unknowns.generator /= scale;
  w /= scale;
  const Matrix4d inverse = w.inverse();
  if (!unknowns.generator.allFinite() || !inverse.allFinite())
    throw std::invalid_argument("the references determine no instrument: its states have no intensity");
  unknowns.analyzer = (empty.analyzer * empty.projected * inverse).transpose();
}

}  // namespace

Unknowns solve_linear(std::span<const Reference> references, const CalibrationOptions& options) {
  const EmptyBeam empty = empty_beam(references, options);
  Unknowns unknowns;
  unknowns.gains.assign(references.size(), 1);
  unknowns.elements.resize(references.size());
  unknowns.leak_real = std::sqrt(options.extinction);
  std::vector<Matrix4d> c;
  double empty_sum = 0, empty_count = 0;
  for (std::size_t i = 0; i < references.size(); ++i) {
    c.push_back(similar(empty, references[i].readings, options));
    const double sum = matrix(references[i].readings, options).sum();
    if (references[i].kind == ReferenceKind::empty) {
      empty_sum += unknowns.gains[i] = sum;
      ++empty_count;
    }
    if (references[i].kind != ReferenceKind::polarizer) continue;
    unknowns.gains[i] = dense::complex_eigenvalues(c[i]).real().maxCoeff();
    if (!(unknowns.gains[i] > 0))
      throw std::invalid_argument("reference " + std::to_string(i + 1) + ": a polarizer that passes nothing");
  }
  for (std::size_t i = 0; i < references.size(); ++i)
    if (references[i].kind == ReferenceKind::empty) unknowns.gains[i] /= empty_sum / empty_count;
  find_wafers(unknowns, references, c, options);
  const Stack stack(references, c, unknowns, options);
  constexpr double half_turn = std::numbers::pi;
  const auto misfit = [&](double offset) { return ratio(stack.at(offset)); };
  const double offset = scanned_minimum(misfit, 0, half_turn, 180, 1e-12);
  unknowns.offset = offset - half_turn * std::floor(offset / half_turn);
  const dense::Svd best = stack.at(unknowns.offset);
  find_states(unknowns, empty, best);
  return unknowns;
}

}  // namespace mmbrdf::calibration
