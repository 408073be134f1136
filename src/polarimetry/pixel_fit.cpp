// SPDX-License-Identifier: BSD-3-Clause
#include "polarimetry/pixel_fit.hpp"

// Of each reading the slopes over at most eight components of states (or the parameters of retarders), those of the
// polarizer and of the reference itself are not 0. Weights are those of what is predicted. Two scales are free: that of W
// to A, held by its first components, and that of A to the gains, held by A; in the end the mean gain is 1.
#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <utility>

#include "polarimetry/calibration_quality.hpp"

namespace mmbrdf::calibration {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr std::size_t most_slopes =
    16;                              // of one reading over what belongs to no reference alone, but for states of a grid
constexpr double small_step = 1e-6;  // in units of χ²: a thousandth of the standard uncertainties

/// Slopes of a reading over what belongs to no reference alone, places rising, and over what is of the reference.
struct Row {
  std::array<Index, most_slopes> places;  // of which there are `count`: not set to 0 for each reading
  std::array<double, most_slopes> slopes;
  std::size_t count = 0;
  Vector4d own = Vector4d::Zero();
  void add(Index place, double slope) {
    places[count] = place;
    slopes[count++] = slope;
  }
};

/// What is of one reference alone: its part of the normal equations, eliminated.
struct Own {
  Matrix4d inverse = Matrix4d::Zero();
  Eigen::Matrix<double, 4, Eigen::Dynamic> cross;  ///< inverse × slopes over the others
  Vector4d step = Vector4d::Zero();
};

class PixelFit {
 public:
  PixelFit(const PixelProblem& problem, std::span<const float> readings)
      : problem_(problem), readings_(readings), x_(problem.start), owns_(problem.references.size()) {
    for (Own& own : owns_) own.cross.resize(4, problem.size);
  }

  FittedPixel run(double most_misfit);

 private:
  void accumulate();
  void accumulate(std::size_t reference, std::span<const Vector4d> w, std::span<const Vector4d> a,
                  std::span<const double> slopes);
  void look_through(const Matrix4d& m, std::span<const Derivative> derivatives, std::span<const Vector4d> w,
                    std::span<const Vector4d> a);
  void add_retarders(Row& row, std::size_t j, const Vector4d& seen, const Vector4d& scattered, double drifted,
                     std::span<const double> all_slopes) const;
  void add_states(const Row& row, Index w, Index a, const Vector4d& seen, const Vector4d& scattered, double residual,
                  Own& mine);
  void add(const Row& row, double residual, Index own, Own& mine);
  void eliminate(Own& own, Index count, Matrix4d square, const Vector4d& values);
  void hold_scales();
  bool solve(double damping);
  void move(const VectorXd& step);
  bool start_gains();
  Index extinction_place() const;
  void normalise();
  VectorXd uncertainties() const;
  Index gain_of_all() const { return 5; }  // where the responsivity of retarders is among the free parameters

  const PixelProblem& problem_;
  std::span<const float> readings_;
  RetarderState x_;
  MatrixXd square_;
  VectorXd values_, step_;
  Eigen::LLT<MatrixXd> factor_;
  std::vector<Own> owns_;
  std::vector<Vector4d> seen_, scattered_, changes_;  // of a reference: Aᵀ M, M W, and Aᵀ dM for each of its slopes
  double chi_squared_ = 0, least_variance_ = 0;
};

Vector4d four(const Stokes& s) { return Map<const Vector4d>(s.data()); }

/// The normal equations at x, without what is of one reference alone.
void PixelFit::accumulate() {
  square_.setZero(problem_.size, problem_.size);
  values_.setZero(problem_.size);
  chi_squared_ = 0;
  std::vector<Vector4d> w, a;
  std::vector<double> all_slopes;
  if (problem_.retarders) {
    const Polarimeter p = polarimeter(x_.instrument, problem_.retarders->dials);
    all_slopes = slopes(x_.instrument, problem_.retarders->dials);
    for (const Stokes& s : p.generator) w.push_back(four(s));
    for (const Stokes& s : p.analyzer) a.push_back(four(s));
  } else {
    for (Index s = 0; s < x_.references.generator.cols(); ++s) w.emplace_back(x_.references.generator.col(s));
    for (Index s = 0; s < x_.references.analyzer.cols(); ++s) a.emplace_back(x_.references.analyzer.col(s));
  }
  for (std::size_t i = 0; i < problem_.references.size(); ++i) accumulate(i, w, a, all_slopes);
  hold_scales();
}

void PixelFit::look_through(const Matrix4d& m, std::span<const Derivative> derivatives, std::span<const Vector4d> w,
                            std::span<const Vector4d> a) {
  seen_.resize(a.size());
  scattered_.resize(w.size());
  changes_.resize(derivatives.size() * a.size());
  for (std::size_t p = 0; p < w.size(); ++p) scattered_[p] = m * w[p];
  for (std::size_t q = 0; q < a.size(); ++q) {
    seen_[q] = m.transpose() * a[q];
    for (std::size_t k = 0; k < derivatives.size(); ++k)
      changes_[k * a.size() + q] = derivatives[k].slope.transpose() * a[q];
  }
}

void PixelFit::accumulate(std::size_t i, std::span<const Vector4d> w, std::span<const Vector4d> a,
                          std::span<const double> all_slopes) {
  const Index own = problem_.own(i), first = problem_.size, drift = own - 1;
  const auto [m, derivatives] =
      reference_slopes(x_.references, problem_.references, i, problem_.options, first, problem_.polarizer);
  Own& mine = owns_[i];
  mine.cross.setZero();
  Matrix4d square = Matrix4d::Zero();
  Vector4d values = Vector4d::Zero();
  const std::size_t n = problem_.readings;
  const bool drifts = problem_.retarders && problem_.options.retarders->fit_drift;
  look_through(m, derivatives, w, a);
  for (std::size_t j = 0, p = 0, q = 0; j < n; ++j) {  // readings of a grid have the generators inside
    const Vector4d &seen = seen_[q], &scattered = scattered_[p];
    const double time = drifts ? problem_.retarders->time(index(j)) : 0, drifted = 1 + x_.drifts[i] * time;
    const double steady = a[q].dot(scattered), expected = drifted * steady;
    const double root = 1 / std::sqrt(std::max(variance(problem_.options.noise, expected), least_variance_));
    const double residual = root * (static_cast<double>(readings_[i * n + j]) - expected);
    Row row;
    if (problem_.retarders) add_retarders(row, j, seen, scattered, root * drifted, all_slopes);
    for (std::size_t k = 0; k < derivatives.size(); ++k) {
      const double slope = root * drifted * changes_[k * a.size() + q].dot(w[p]);
      if (const Index place = derivatives[k].place; place < first)
        row.add(place, slope);
      else
        row.own(place - first) = slope;
    }
    if (drifts) row.own(drift) = root * time * steady;
    chi_squared_ += residual * residual;
    if (!problem_.retarders)
      add_states(row, 4 * index(p), 4 * index(w.size() + q), root * seen, root * scattered, residual, mine);
    add(row, residual, own, mine);
    square += row.own * row.own.transpose();
    values += residual * row.own;
    if (problem_.retarders || ++p == w.size()) {
      p = problem_.retarders ? p + 1 : 0;
      ++q;
    }
  }
  eliminate(mine, own, square, values);
}

void PixelFit::add_retarders(Row& row, std::size_t j, const Vector4d& seen, const Vector4d& scattered, double factor,
                             std::span<const double> all_slopes) const {
  const double* const slopes = all_slopes.data() + 4 * j * retarder_parameters;
  const Map<const RowMajor> of_w(slopes, 4, retarder_parameters);
  const Map<const RowMajor> of_a(slopes + 4 * problem_.readings * retarder_parameters, 4, retarder_parameters);
  for (std::size_t k = 0; k < problem_.retarders->free.size(); ++k) {
    const Index parameter = index(problem_.retarders->free[k]);
    row.add(index(k), factor * (of_w.col(parameter).dot(seen) + of_a.col(parameter).dot(scattered)));
  }
}

/// To the normal equations: the slopes over a state of W and one of A, at w and a, with each other and with those of the
/// row, which come behind them.
void PixelFit::add_states(const Row& row, Index w, Index a, const Vector4d& seen, const Vector4d& scattered,
                          double residual, Own& mine) {
  square_.block<4, 4>(w, w).noalias() += seen * seen.transpose();
  square_.block<4, 4>(a, w).noalias() += scattered * seen.transpose();
  square_.block<4, 4>(a, a).noalias() += scattered * scattered.transpose();
  for (std::size_t r = 0; r < row.count; ++r) {
    square_.row(row.places[r]).segment<4>(w) += row.slopes[r] * seen.transpose();
    square_.row(row.places[r]).segment<4>(a) += row.slopes[r] * scattered.transpose();
  }
  values_.segment<4>(w) += residual * seen;
  values_.segment<4>(a) += residual * scattered;
  mine.cross.middleCols<4>(w).noalias() += row.own * seen.transpose();
  mine.cross.middleCols<4>(a).noalias() += row.own * scattered.transpose();
}

/// To the normal equations. All is in units of the standard deviation.
void PixelFit::add(const Row& row, double residual, Index own, Own& mine) {
  for (std::size_t r = 0; r < row.count; ++r) {
    const double slope = row.slopes[r];
    const Index place = row.places[r];
    for (std::size_t c = 0; c <= r; ++c) square_(place, row.places[c]) += slope * row.slopes[c];
    values_(place) += slope * residual;
    for (Index k = 0; k < own; ++k) mine.cross(k, place) += slope * row.own(k);
  }
}

void PixelFit::eliminate(Own& own, Index count, Matrix4d square, const Vector4d& values) {
  for (Index k = count; k < 4; ++k) square(k, k) = 1;
  const Eigen::LLT<Matrix4d> factor(square);
  own.inverse = factor.solve(Matrix4d::Identity());
  own.step = own.inverse * values;
  const MatrixXd solved = own.inverse.topLeftCorner(count, count) * own.cross.topRows(count);
  values_.noalias() -= own.cross.topRows(count).transpose() * own.step.head(count);
  for (Index k = 0; k < count; ++k) {
    const VectorXd row = own.cross.row(k);
    for (Index c = 0; c < problem_.size; ++c)
      if (const double factor_of = solved(k, c); factor_of != 0)
        square_.col(c).tail(problem_.size - c).noalias() -= factor_of * row.tail(problem_.size - c);
  }
  own.cross.topRows(count) = solved;
}

/// Rows that the readings do not tell anything of: they change no misfit, and end in 0.
void PixelFit::hold_scales() {
  const double firm = square_.diagonal().mean();
  if (problem_.retarders) {
    square_(gain_of_all(), gain_of_all()) += firm;
    return;
  }
  const Index states = 4 * index(problem_.generators);
  for (Index p = 0; p < states; p += 4)
    for (Index r = 0; r <= p; r += 4) square_(p, r) += firm;
  values_(Eigen::seq(0, states - 1, 4)).array() +=
      firm * (static_cast<double>(problem_.generators) - x_.references.generator.row(0).sum());
  const Map<const VectorXd> a(problem_.start.references.analyzer.data(), 4 * index(problem_.analyzers));
  square_.block(states, states, a.size(), a.size()).triangularView<Eigen::Lower>() +=
      firm / a.squaredNorm() * a * a.transpose();
}

/// Of retarders, if it is fitted; else −1.
Index PixelFit::extinction_place() const {
  for (std::size_t k = 0; problem_.retarders && k < problem_.retarders->free.size(); ++k)
    if (problem_.retarders->free[k] == 8) return index(k);
  return -1;
}

bool PixelFit::solve(double damping) {
  MatrixXd damped = square_;
  damped.diagonal() *= 1 + damping;
  factor_.compute(damped);
  if (factor_.info() != Eigen::Success) return false;
  step_ = factor_.solve(values_);
  if (const Index at = extinction_place(); at >= 0 && x_.instrument.extinction <= 0 && step_(at) < 0) {  // it stays 0
    damped(at, at) *= 1e12;
    step_ = Eigen::LLT<MatrixXd>(damped).solve(values_);
  }
  return step_.allFinite();
}

void PixelFit::move(const VectorXd& step) {
  std::vector<Index> first;
  Index next = problem_.size;
  for (std::size_t i = 0; i < owns_.size(); ++i) {
    first.push_back(next);
    next += problem_.own(i);
  }
  VectorXd all(next);
  all.head(problem_.size) = step;
  for (std::size_t i = 0; i < owns_.size(); ++i) {
    const Index count = problem_.own(i);
    all.segment(first[i], count) = owns_[i].step.head(count) - owns_[i].cross.topRows(count) * step;
    if (problem_.retarders && problem_.options.retarders->fit_drift) x_.drifts[i] += all(first[i] + count - 1);
  }
  move_references(x_.references, problem_.references, all, first, problem_.polarizer);
  if (problem_.retarders) {
    const auto places = parameters(x_.instrument);
    for (std::size_t k = 0; k < problem_.retarders->free.size(); ++k)
      *places[problem_.retarders->free[k]] += step(index(k));
    x_.instrument.extinction = std::clamp(x_.instrument.extinction, 0., 1.);
    for (RetarderArm* arm : {&x_.instrument.generator, &x_.instrument.analyzer})
      arm->diattenuation = std::clamp(arm->diattenuation, -0.999, 0.999);
    return;
  }
  x_.references.generator.reshaped() += step.head(4 * index(problem_.generators));
  x_.references.analyzer.reshaped() += step.segment(4 * index(problem_.generators), 4 * index(problem_.analyzers));
}

/// The brightness of the pixel: what its empty references say. False if they say nothing.
bool PixelFit::start_gains() {
  double sum = 0, expected = 0;
  for (const float reading : readings_)
    least_variance_ = std::max(least_variance_, std::abs(static_cast<double>(reading)));
  least_variance_ = std::max(least_sigma * least_sigma * least_variance_ * least_variance_, 1e-300);
  const Polarimeter retarders =
      problem_.retarders ? polarimeter(x_.instrument, problem_.retarders->dials) : Polarimeter{};
  const MatrixXd grid = x_.references.analyzer.transpose() * x_.references.generator;
  for (std::size_t i = 0; i < owns_.size(); ++i) {
    for (std::size_t j = 0; j < problem_.readings; ++j)
      if (!std::isfinite(readings_[i * problem_.readings + j])) return false;
    if (problem_.references[i].kind != ReferenceKind::empty) continue;
    for (std::size_t j = 0; j < problem_.readings; ++j) {
      sum += static_cast<double>(readings_[i * problem_.readings + j]);
      expected += x_.references.gains[i] * (problem_.retarders
                                                ? four(retarders.analyzer[j]).dot(four(retarders.generator[j]))
                                                : grid(index(j / problem_.generators), index(j % problem_.generators)));
    }
  }
  const double bright = sum / expected;
  if (!(bright > 0) || !std::isfinite(bright)) return false;
  x_.instrument.responsivity *= bright;
  x_.references.analyzer *= bright;
  return true;
}

/// Mean gain of the empty references to 1.
void PixelFit::normalise() {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < owns_.size(); ++i)
    if (problem_.references[i].kind == ReferenceKind::empty) {
      sum += x_.references.gains[i];
      ++count;
    }
  const double mean = sum / count;
  x_.references.analyzer *= mean;
  x_.instrument.responsivity *= mean;
  for (std::size_t i = 0; i < owns_.size(); ++i) {
    x_.references.gains[i] /= mean;
    x_.references.elements[i].tau /= mean;
  }
}

/// Of what belongs to no reference alone, the mean gain of the empty references being 1 and not what the solution held.
VectorXd PixelFit::uncertainties() const {
  const MatrixXd covariance = factor_.solve(MatrixXd::Identity(problem_.size, problem_.size));
  VectorXd of_gain = VectorXd::Zero(problem_.size);  // slopes of the mean gain
  double own = 0, count = 0;
  for (std::size_t i = 0; i < owns_.size(); ++i) {
    if (problem_.references[i].kind != ReferenceKind::empty) continue;
    of_gain -= owns_[i].cross.row(0).transpose();
    own += owns_[i].inverse(0, 0);
    ++count;
  }
  of_gain /= count;
  const double misfit = chi_squared_ / static_cast<double>(problem_.degrees_of_freedom);
  const VectorXd with_gain = covariance * of_gain;
  const double of_mean = of_gain.dot(with_gain) + own / (count * count);
  const double scale = scale_uncertainty(x_.references, problem_.references);
  VectorXd result = misfit * covariance.diagonal();
  const auto add = [&](Index place, double value) {  // value = mean gain × what was held
    result(place) += misfit * (2 * value * with_gain(place) + value * value * of_mean) + scale * scale * value * value;
  };
  if (problem_.retarders) add(gain_of_all(), x_.instrument.responsivity);
  for (Index k = 0; !problem_.retarders && k < x_.references.analyzer.size(); ++k)
    add(4 * index(problem_.generators) + k, x_.references.analyzer.reshaped()(k));
  return result.cwiseMax(0).cwiseSqrt();
}

FittedPixel PixelFit::run(double most_misfit) {
  FittedPixel result{x_, VectorXd::Constant(problem_.size, std::nan("")), std::nan(""), PixelFailure::not_finite};
  if (!start_gains()) return result;
  result.failure = PixelFailure::no_convergence;
  double damping = 0, last = 0;
  RetarderState before = x_;
  bool ended = false;
  for (int k = 0; k < most_pixel_steps && !ended; ++k) {
    accumulate();
    if (k > 0 && !(chi_squared_ <= last * (1 + 1e-3) + 1e-6)) {  // weights move as well
      damping = std::max(10 * damping, 1e-3);
      x_ = before;
      accumulate();
    } else {
      damping /= 10;
    }
    last = chi_squared_;
    before = x_;
    if (!solve(damping)) return result;
    ended = values_.dot(step_) <= small_step;
    move(step_);
  }
  // The last step is small: the equations before it are those after it, and it takes values · step from χ².
  if (!ended || !solve(0)) return result;
  chi_squared_ -= values_.dot(step_);
  if (!std::isfinite(chi_squared_)) return result;
  normalise();
  result.misfit = chi_squared_ / static_cast<double>(problem_.degrees_of_freedom);
  result.x = x_;
  result.uncertainties = uncertainties();
  result.failure = result.misfit <= most_misfit ? PixelFailure::none : PixelFailure::misfit;
  return result;
}

}  // namespace

FittedPixel fit_pixel(const PixelProblem& problem, std::span<const float> readings, double most_misfit) {
  return PixelFit(problem, readings).run(most_misfit);
}

}  // namespace mmbrdf::calibration
