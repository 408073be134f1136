// SPDX-License-Identifier: BSD-3-Clause
/// From samples to a model, by linear least squares.
///
/// f11 is fitted directly (divided by the reflectance where there is one), the other elements as m_ij = f_ij / f11.
/// What was not measured (samples.hpp) has weight 0, in the frame in which it was not measured where rows_turn(); a block without a row is not in the model, which then does not know
/// its elements; nor is one that rows in another frame than xy leave open, and of which some elements have none. Elements that reciprocity or the basis ties together are fitted together, block by block. With y the samples of a
/// block, X its modes at their geometries and W the weights, the coefficients minimise ‖W^½ (X a − y)‖, and
///
///     covariance(a) = s² (Xᵀ W X)⁺,     s² = ‖W^½ (X a − y)‖² / (rows − rank).
///
/// That holds for independent errors whose variances are as 1/W. Speckle noise grows towards grazing angles: use
/// Weights::speckle for it. It does not hold where the model misses structure that the sample has; then s² contains the
/// misfit, but correlated. Blocks are fitted apart from each other, so coefficients of different blocks are
/// uncorrelated. A reflectance that comes from the data themselves has errors of its own, which also enter the
/// coefficients of f11: the model keeps the covariance of both.
///
/// WARNING: the published index sets (germer2017) are not determined by data with one azimuth of the source. Their
/// solution is the one of minimum norm, as in the published files, and combinations that the data say nothing about
/// have variance 0 there, not infinity. Ask Solution::estimable() before trusting a prediction.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/model/model.hpp"
#include "mmbrdf/numerics/least_squares.hpp"
#include "mmbrdf/samples/noise.hpp"
#include "mmbrdf/samples/samples.hpp"

namespace mmbrdf {

/// What is fitted: which modes, and how azimuths enter. Samples for germer2017 are turned to phi_i = 0 first, as its
/// models are evaluated, unless rotation is as_printed: then they are fitted at the azimuths they have, to compare with
/// what the paper did, and the model is evaluated so.
struct Basis {
  Family family = Family::isotropic;
  Orders orders;
  DiscMapping mapping = DiscMapping::lambert;
  Rotation rotation = Rotation::covariant;
  friend bool operator==(const Basis&, const Basis&) = default;
};
inline bool turns(const Basis& basis) { return turns(basis.family, basis.rotation); }

/// Whether rows can be turned into the frame in which a sample was measured (Sample::as_measured): where each block has
/// all the elements that rotation mixes. So it is in the isotropic family. Else samples are taken in xy.
bool rows_turn(Family family);

enum class Weights {
  none,  ///< every row counts the same
  speckle,  ///< 1/σ² of the speckle law σ = C √(cos θi / cos θr), relative for f11 and absolute for m_ij (theory 3.3).
            ///< f11 is then fitted twice: the first, unweighted fit tells what σ is relative to.
  data,  ///< 1/u² of the samples' own uncertainties u, all of which must be known: data_weights(), with the reflectance
         ///< of the first, unweighted fit.
  estimated,  ///< 1/σ² of the law that estimate_noise() finds, at each wavelength, in what the first fit leaves of the
              ///< elements 14 and 41; relative and absolute as for speckle.
};

enum class Covariance {
  residuals,  ///< s² (Xᵀ W X)⁺: right if the weights are as 1/variance
  sandwich,  ///< (Xᵀ W X)⁺ Xᵀ W diag(r²) W X (Xᵀ W X)⁺ × rows / (rows − rank): for residuals that are not as uniform as
             ///< the weights say. Errors of different elements count as independent. White 1980.
  given,     ///< (Xᵀ W X)⁺: of weights 1/u², whatever the residuals are. fit() takes it with Weights::data only.
};

/// What the uncertainties of a fit hold for.
enum class Uncertainty {
  sample,  ///< a real sample: the mixed model of theory 8. Its modes of generous order, its anisotropy and the noise are
           ///< estimated together, whatever the rank of the data; the evaluated coefficients are the nearest to the
           ///< posterior mean. Of bases that are isotropic.
  noise,   ///< the noise alone, as if the sample were isotropic and the basis without end: least squares
};

/// "none", "speckle", "data", "estimated"; "residuals", "sandwich", "given"; "sample", "noise". The opposites throw
/// std::invalid_argument for another name.
std::string to_string(Weights weights);
std::string to_string(Covariance covariance);
std::string to_string(Uncertainty uncertainty);
Weights weights_from(const std::string& name);
Covariance covariance_from(const std::string& name);
Uncertainty uncertainty_from(const std::string& name);

struct FitOptions {
  std::optional<int> powers;  ///< highest power of the wavelength; default 0 for one wavelength, 1 for several
  std::optional<ReflectanceTable>
      reflectance;            ///< f11 is divided by it; an empty table: by nothing. Default for several
                              ///< wavelengths: each one's own normal-incidence DHR; for one: nothing.
  bool minimum_norm = false;  ///< accept data that do not determine every mode. Always so for germer2017.
  /// Singular values below this part of the largest count as 0: 1e-8 to 1e-13 all give the published files, and the
  /// published grid, whose incidence at 0.001 degrees is as good as 0, is found not to determine order 11.
  double rank_tolerance = 1e-8;
  Covariance covariance = Covariance::residuals;  ///< sandwich needs the samples again: only in fit()
  /// sample: only in fit(). Where it cannot be had the fit is as for noise, and FitResult::warnings says why.
  Uncertainty uncertainty = Uncertainty::noise;
  DeclaredErrors declared{};  ///< of a fit of the sample
};

/// How well one matrix element is fitted. An element without modes is 0 in the model, and its samples are the
/// residuals.
struct ElementFit {
  long rows = 0;
  double rms = 0;          ///< √(Σ w r² / Σ w) of the residuals r; those of f11 are of f11 / reflectance
  double chi_squared = 0;  ///< Σ w r²
  double weight = 0;       ///< Σ w
};

struct FitResult {
  Model model;
  std::vector<Solution> solutions;      ///< one for each block of the model
  std::array<ElementFit, 16> elements;  ///< in row-major order
  std::vector<Mueller> residuals;  ///< one for each sample, measured − model in the xy frame: f11 in sr⁻¹, others m_ij.
                                   ///< Only from fit(); a FitAccumulator keeps no samples.
  std::vector<NoiseEstimate> noise;       ///< of Weights::estimated: the law at each fitted wavelength; else empty
  std::vector<std::string> warnings;      ///< a line each, only from fit(); more in fit_warnings()
  Sides sides = no_side;                  ///< of the plane of incidence on which there are samples
  Weights weights = Weights::none;        ///< those of fit(); a FitAccumulator knows no name for what it is given
  std::vector<Mueller> sample_weights{};  ///< of each sample, as add() takes them; empty: 1. Only from fit()
};

/// Root mean square over the 15 normalised elements.
double polarization_rms(const FitResult& result);

/// Takes samples in any order and number, and solves whenever asked. Memory grows with the number of distinct
/// wavelengths and with the orders, not with the number of samples.
class FitAccumulator {
 public:
  /// Throws std::invalid_argument for orders that are out of range or need more than LeastSquares::max_unknowns, and
  /// for as_printed of another family than germer2017.
  explicit FitAccumulator(const Basis& basis);

  /// Weights, one matrix for each sample: element 11 is the weight of f11 / reflectance, the others those of m_ij (of
  /// the turned m_ij where samples are turned, of those as_measured where rows are). Empty means 1. Throws std::invalid_argument for an invalid sample or
  /// weight, before anything is added.
  void add(std::span<const Sample> samples, std::span<const Mueller> weights = {});

  /// As if all of other's samples had been added here. Throws std::invalid_argument for another basis.
  void merge(const FitAccumulator& other);

  /// Of the same samples at other orders. Throws std::invalid_argument if one is higher than those of the basis.
  FitAccumulator at_orders(const Orders& orders) const;

  long samples() const { return samples_; }

  /// Everything there is, as numbers to be saved or sent: from_state() of the same basis makes the same accumulator, to
  /// the last bit. So parts of the samples can be added in different processes and merged in one.
  std::vector<double> state() const;
  /// Throws std::invalid_argument unless the numbers are a state of this basis.
  static FitAccumulator from_state(const Basis& basis, std::span<const double> state);

  /// Throws std::invalid_argument for no samples, more powers than the wavelengths tell, a reflectance table that does not
  /// reach one, a sandwich covariance; and, without minimum_norm, for samples that do not determine the model: the message
  /// says which modes are free, whether all samples lie in one plane, and which orders they do determine.
  FitResult solve(const FitOptions& options = {}) const;

  /// How well a model, of whatever data, fits the samples: their f11 is divided by its reflectance. Throws
  /// std::invalid_argument for a model of another basis, or if one turns samples and the other does not.
  std::array<ElementFit, 16> misfit(const Model& model) const;

 private:
  struct Measured {  // where
    DirectionPairs pairs;
    double theta_i_max = 0, theta_r_max = 0;
    friend bool operator==(const Measured&, const Measured&) = default;
  };
  struct AtWavelength {
    std::vector<LeastSquares> elements;          // 16, in row-major order, over the modes of the element's block
    std::array<double, 16> weight{};             // Σ w
    std::map<unsigned long, Measured> measured;  // by the elements that were, with those of their blocks
  };

  struct Design;   // modes of elements: fit_rows.cpp
  struct Folding;  // of samples into triangles: there too
  struct Turned;   // samples as they were measured in another frame: there too
  void add_as_measured(std::span<const Sample> samples, std::span<const Mueller> weights);
  static std::shared_ptr<const std::vector<Design>> designs(std::span<const Block> blocks, Family family);
  AtWavelength& slot(double wavelength);
  friend FitResult fit(std::span<const Sample>, const Basis&, const FitOptions&, Weights);
  friend FitResult fit_to_predict(const FitAccumulator&, const FitOptions&, SvdCache&);  // for selection
  static FitResult of_noise(std::span<const Sample> samples, const Basis& basis, const FitOptions& options,
                            Weights weights);
  friend class MixedRounds;  // whose weights are known up to a reflectance
  void weigh_f11(double factor);
  FitResult solved(const FitOptions& options, SvdCache& known, bool covariances) const;
  FitResult solved(const FitOptions& options) const;
  DirectionPairs::Grid grid() const;
  Measured& measured_of(AtWavelength& at, unsigned long elements) const;
  Elements with_their_blocks(const Elements& elements) const;
  std::vector<Measured> measured_at(const AtWavelength& at, const Elements& not_measured) const;
  void set_angles(Validity& validity, const Elements& not_measured) const;
  std::vector<SupportedPairs> support(const Model& model) const;
  Solution block_solution(std::size_t block, int powers, const ReflectanceTable& reflectance, double rank_tolerance,
                          SvdCache& known) const;
  void add_own_reflectance_covariance(FitResult& result, const FitOptions& options, SvdCache& known,
                                      const FitAccumulator* squares) const;
  void use_sandwich(FitResult& result, const FitOptions& options, const FitAccumulator& squares) const;
  bool takes_own_reflectance(const FitOptions& options) const;
  bool turns() const;
  bool accepts_minimum_norm(const FitOptions& options) const;
  std::string determined_orders(const FitOptions& options) const;
  void require_determined(const std::string& refusal, const std::string& free, const FitOptions& options) const;
  bool leave_out_undetermined(const Block& block, const Solution& solution, FitResult& result) const;
  int chosen_powers(const FitOptions& options) const;
  ReflectanceTable own_reflectance(const FitOptions& options, SvdCache& known) const;
  Elements not_measured() const;
  void require_covered(const ReflectanceTable& table) const;
  ElementFit element_fit(std::size_t element, std::span<const double> x, const ReflectanceTable& reflectance) const;

  Basis basis_;
  std::vector<Block> blocks_;
  std::array<int, 16> block_of_{};  // −1: no block feeds the element
  std::shared_ptr<const std::vector<Design>> designs_;
  std::map<double, AtWavelength> wavelengths_;
  Sides sides_ = no_side;
  bool has_turned_rows_ = false;
  long samples_ = 0;
};

/// Fits samples held in memory. Throws as FitAccumulator does.
FitResult fit(std::span<const Sample> samples, const Basis& basis = {}, const FitOptions& options = {},
              Weights weights = Weights::none);

/// As the program and Python fit by default: with the uncertainty of the sample, and weights of the speckle law.
FitResult fit_sample(std::span<const Sample> samples, const Basis& basis = {}, FitOptions options = {});

}  // namespace mmbrdf
