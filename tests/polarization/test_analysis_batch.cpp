// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarization/analysis_batch.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "given/random_mueller.hpp"
#include "polarization/kernel/analysis_kernels.hpp"

using namespace mmbrdf;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::vector<Mueller> realizable_matrices(std::size_t count, std::uint64_t seed) {
  RandomMueller source(seed);
  std::vector<Mueller> result(count);
  for (Mueller& m : result) m = source.realizable();
  return result;
}

/// Of these some can exist, some nearly, some not.
std::vector<Mueller> with_noise(std::vector<Mueller> matrices, std::uint64_t seed) {
  RandomMueller source(seed);
  for (Mueller& m : matrices) {
    const double noise = std::pow(10, source.between(-17, 0)) * m(0, 0);
    for (std::size_t e = 1; e < 16 && source.below(3) > 0; ++e) m.elements[e] += source.between(-noise, noise);
  }
  return matrices;
}

struct Answers {
  std::vector<double> numbers;
  std::vector<unsigned char> left;
};

Answers ask(const AnalysisKernel& kernel, Analysis analysis, const std::vector<Mueller>& matrices) {
  Answers result{std::vector<double>(matrices.size() * numbers_of[static_cast<std::size_t>(analysis)]),
                 std::vector<unsigned char>(matrices.size())};
  kernel.run(analysis, matrices[0].elements.data(), matrices.size(), result.numbers.data(), result.left.data());
  return result;
}

constexpr Analysis every_analysis[] = {
    Analysis::realizable,
    Analysis::depolarization,
    Analysis::diattenuation,
    Analysis::polarizance,
    Analysis::purity,
    Analysis::realizability_margin,
    Analysis::entropy,
    Analysis::lu_chipman,
    Analysis::symmetric_decomposition,
    Analysis::coherency_eigenvalues,
    Analysis::cloude_decomposition,
    Analysis::nearest_realizable,
    Analysis::ratios,
};

std::vector<const AnalysisKernel*> kernels_that_run_here() {
  std::vector<const AnalysisKernel*> result;
  for (const AnalysisKernel* kernel : analysis_kernels())
    if (kernel->runs_here()) result.push_back(kernel);
  return result;
}

using Extended = std::complex<long double>;

/// Rising, with 11 more bits.
std::array<long double, 4> extended_eigenvalues(const Mueller& m) {
  const Coherency exact = coherency(m);  // sums of two numbers, done again below
  Eigen::Matrix<Extended, 4, 4> t;
  const auto e = [&](int i, int j) { return static_cast<long double>(m(i, j)); };
  const Extended i(0, 1);
  t << e(0, 0) + e(0, 1) + e(1, 0) + e(1, 1), (e(0, 2) + e(1, 2)) + i * (e(0, 3) + e(1, 3)),
      (e(2, 0) + e(2, 1)) - i * (e(3, 0) + e(3, 1)), (e(2, 2) + e(3, 3)) + i * (e(2, 3) - e(3, 2)),  //
      0, e(0, 0) - e(0, 1) + e(1, 0) - e(1, 1), (e(2, 2) - e(3, 3)) - i * (e(2, 3) + e(3, 2)),
      (e(2, 0) - e(2, 1)) - i * (e(3, 0) - e(3, 1)),                                               //
      0, 0, e(0, 0) + e(0, 1) - e(1, 0) - e(1, 1), (e(0, 2) - e(1, 2)) + i * (e(0, 3) - e(1, 3)),  //
      0, 0, 0, e(0, 0) - e(0, 1) - e(1, 0) + e(1, 1);
  t /= 4;
  for (int row = 0; row < 4; ++row)
    for (int column = row; column < 4; ++column) {
      const std::complex<double> of_library = exact[static_cast<std::size_t>(4 * row + column)];
      EXPECT_LE(std::abs(Extended(of_library) - t(row, column)), 1e-15L * largest(m));
      t(column, row) = std::conj(t(row, column));
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Extended, 4, 4>> solver(t, Eigen::EigenvaluesOnly);
  return {solver.eigenvalues()[0], solver.eigenvalues()[1], solver.eigenvalues()[2], solver.eigenvalues()[3]};
}

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

TEST(AnalysisKernel, HasTheEigenvaluesOfExtendedPrecision) {
  std::vector<Mueller> matrices = with_noise(realizable_matrices(4000, 1), 2);
  for (double& scale : std::array{1e-120, 1e120})
    for (std::size_t q = 0; q < 50; ++q) matrices.push_back(scale / matrices[q](0, 0) * matrices[q]);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::coherency_eigenvalues, matrices);
    int left = 0;
    for (std::size_t m = 0; m < matrices.size(); ++m) {
      if (answers.left[m] != 0) {
        ++left;
        continue;
      }
      const std::array<long double, 4> expected = extended_eigenvalues(matrices[m]);
      for (std::size_t q = 0; q < 4; ++q)
        ASSERT_LE(std::abs(static_cast<double>(answers.numbers[4 * m + q] - expected[q])),
                  eigenvalue_error * largest(matrices[m]))
            << kernel->name << ", matrix " << m;
    }
    EXPECT_LT(left, 1000);  // those beyond 2^±400
  }
}

TEST(AnalysisKernel, NeverMakesNanOfWhatItAnswers) {
  RandomMueller source(3);
  std::vector<Mueller> matrices(3000);
  for (Mueller& m : matrices) {
    m = source.below(2) == 0 ? source.anything() : source.realizable();
    if (source.below(20) == 0) m.elements[static_cast<std::size_t>(source.below(16))] = not_a_number;
    if (source.below(20) == 0) m(0, 0) = source.below(2) == 0 ? 0 : -m(0, 0);
  }
  for (const AnalysisKernel* kernel : kernels_that_run_here())
    for (const Analysis analysis : every_analysis) {
      const Answers answers = ask(*kernel, analysis, matrices);
      const std::size_t each = numbers_of[static_cast<std::size_t>(analysis)];
      for (std::size_t i = 0; i < answers.numbers.size(); ++i)
        ASSERT_TRUE(answers.left[i / each] != 0 || std::isfinite(answers.numbers[i]))
            << kernel->name << ", matrix " << i / each;
    }
}

TEST(AnalysisKernel, GivesAMatrixTheSameBitsWhateverItsNeighbours) {
  RandomMueller source(4);
  std::vector<Mueller> matrices = with_noise(realizable_matrices(400, 5), 6);
  for (std::size_t q = 0; q < 400; q += 7) matrices[q] = source.anything();
  for (const AnalysisKernel* kernel : kernels_that_run_here())
    for (const Analysis analysis : every_analysis) {
      const std::size_t each = numbers_of[static_cast<std::size_t>(analysis)];
      const Answers together = ask(*kernel, analysis, matrices);
      for (std::size_t q = 0; q < matrices.size(); ++q) {
        const Answers alone = ask(*kernel, analysis, {matrices[q]});
        ASSERT_EQ(alone.left[0], together.left[q]);
        for (std::size_t i = 0; alone.left[0] == 0 && i < each; ++i)
          ASSERT_TRUE(same_bits(alone.numbers[i], together.numbers[each * q + i])) << kernel->name << ", matrix " << q;
      }
    }
}

TEST(AnalysisKernel, FindsRealizableWhatEigenvaluesDo) {
  std::vector<Mueller> matrices = with_noise(realizable_matrices(6000, 7), 8);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::realizable, matrices);
    int possible = 0, compared = 0;
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      const auto margin = static_cast<double>(extended_eigenvalues(matrices[q])[0] / matrices[q](0, 0));
      if (answers.left[q] != 0 || std::abs(margin + realizability_tolerance) < 1e-14) continue;  // to rounding
      ASSERT_EQ(answers.numbers[q], margin > -realizability_tolerance ? 1 : 0) << margin << " " << kernel->name;
      possible += margin > -realizability_tolerance ? 1 : 0;
      ++compared;
    }
    EXPECT_GT(possible, compared / 5);
    EXPECT_LT(possible, compared * 4 / 5);
  }
}

TEST(AnalysisKernel, HasTheEntropyOfTheEigenvalues) {
  const std::vector<Mueller> matrices = realizable_matrices(3000, 9);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::entropy, matrices);
    for (std::size_t m = 0; m < matrices.size(); ++m) {
      if (answers.left[m] != 0) continue;
      long double sum = 0;
      for (const long double value : extended_eigenvalues(matrices[m])) {
        const long double p = value / matrices[m](0, 0);
        if (p > 0) sum -= p * std::log2(p) / 2;
      }
      // An eigenvalue of 0 ± 1e-15 counts 50 times as much.
      ASSERT_NEAR(answers.numbers[m], static_cast<double>(sum), 3e-13) << kernel->name;
    }
  }
}

/// The matrices that the kernel wrote from number `first` on.
template <std::size_t count>
std::array<Mueller, count> matrices_at(const Answers& answers, std::size_t first) {
  std::array<Mueller, count> result;
  for (std::size_t f = 0; f < count; ++f)
    std::copy_n(answers.numbers.begin() + static_cast<std::ptrdiff_t>(first + 16 * f), 16, result[f].elements.begin());
  return result;
}

TEST(AnalysisKernel, MultipliesTheFactorsOfLuAndChipmanBack) {
  const std::vector<Mueller> matrices = realizable_matrices(6000, 10);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::lu_chipman, matrices);
    int answered = 0;
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      if (answers.left[q] != 0) continue;
      ++answered;
      const std::array<Mueller, 3> factor = matrices_at<3>(answers, 48 * q);
      const Mueller& m = matrices[q];
      ASSERT_LE(largest(factor[0] * factor[1] * factor[2] - m), lu_chipman_error * m(0, 0)) << kernel->name;
      ASSERT_LE(largest(factor[1] * transpose(factor[1]) - identity()), 1e-14);
      ASSERT_GT(factor[1](1, 1) + factor[1](2, 2) + factor[1](3, 3), -1 - 1e-14);  // turns, without a reflection
      for (int i = 1; i < 4; ++i)
        for (int j = 1; j < i; ++j) ASSERT_EQ(factor[0](i, j), factor[0](j, i));
    }
    EXPECT_GT(answered, 2000);  // the others have a polarizer or one pure part, or lie beyond 2^±400
  }
}

double determinant(const Mueller& retarder) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3 + 1, j = (k + 2) % 3 + 1;
    sum += retarder(1, k + 1) * (retarder(2, i) * retarder(3, j) - retarder(2, j) * retarder(3, i));
  }
  return sum;
}

// The kernel multiplies the factors, and leaves those that are not n to 1e-13; here rounding comes on top.
TEST(AnalysisKernel, MultipliesTheSymmetricFactorsBack) {
  const std::vector<Mueller> matrices = realizable_matrices(6000, 18);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::symmetric_decomposition, matrices);
    int answered = 0;
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      if (answers.left[q] != 0) continue;
      ++answered;
      const auto [d2, r2, depolarizer, r1, d1] = matrices_at<5>(answers, 80 * q);
      const Mueller& m = matrices[q];
      ASSERT_LE(largest(d2 * r2 * depolarizer * transpose(r1) * d1 - m), 1.5e-13 * m(0, 0)) << kernel->name;
      for (const Mueller& retarder : {r1, r2}) {
        ASSERT_LE(largest(retarder * transpose(retarder) - identity()), 1e-14);
        ASSERT_NEAR(determinant(retarder), 1, 1e-14);
      }
      for (const Mueller& d : {d1, d2}) {
        ASSERT_EQ(d, transpose(d));
        ASSERT_NEAR(depolarization(d), 1, 1e-14);
      }
      const double* e = depolarizer.elements.data();
      ASSERT_EQ(depolarizer, diagonal(e[0], e[5], e[10], e[15]));
      ASSERT_TRUE(e[5] >= e[10] && e[10] >= std::abs(e[15])) << e[5] << " " << e[10] << " " << e[15];
    }
    EXPECT_GT(answered, 2000);  // the others have a polarizer, or lie beyond 2^±400
  }
}

TEST(AnalysisKernel, HasNoDiattenuatorInFrontOfAMatrixThatDoesNotDepolarize) {
  RandomMueller source(19);
  std::vector<Mueller> matrices(2000);
  for (Mueller& m : matrices) m = source.pure(0);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::symmetric_decomposition, matrices);
    EXPECT_LT(std::ranges::count(answers.left, 1), 20);  // beside nearly a polarizer digits are few
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      if (answers.left[q] != 0) continue;
      const auto factors = matrices_at<5>(answers, 80 * q);
      ASSERT_EQ(factors[4], identity()) << kernel->name;
      ASSERT_NEAR(factors[2](3, 3) / factors[2](0, 0), 1, 1e-12);
    }
  }
}

TEST(AnalysisKernel, LeavesWhatHasNoDiagonalDepolarizerOrManyRetarders) {
  const Mueller second_type{{2, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3}};  // Ossikovski 2010
  const std::vector<Mueller> matrices{second_type, diagonal(1, 0, 0, 0), diagonal(1, 0.5, 0, 0),
                                      diagonal(1, 0.5, 1e-12, 1e-13)};
  for (const AnalysisKernel* kernel : kernels_that_run_here())
    EXPECT_EQ(ask(*kernel, Analysis::symmetric_decomposition, matrices).left, std::vector<unsigned char>(4, 1));
}

TEST(AnalysisKernel, SumsCloudesPartsToTheMatrix) {
  const std::vector<Mueller> matrices = with_noise(realizable_matrices(3000, 11), 12);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::cloude_decomposition, matrices);
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      if (answers.left[q] != 0) continue;
      Mueller sum;
      for (std::size_t e = 0; e < 16; ++e)
        for (std::size_t part = 0; part < 4; ++part)
          sum.elements[e] += answers.numbers[68 * q + part] * answers.numbers[68 * q + 4 + 16 * part + e];
      ASSERT_LE(largest(sum - matrices[q]), 1e-14 * largest(matrices[q])) << kernel->name;
    }
  }
}

TEST(AnalysisKernel, MovesAMatrixToTheNearestThatCanExist) {
  const std::vector<Mueller> matrices = with_noise(realizable_matrices(3000, 13), 14);
  for (const AnalysisKernel* kernel : kernels_that_run_here()) {
    const Answers answers = ask(*kernel, Analysis::nearest_realizable, matrices);
    int moved = 0;
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      if (answers.left[q] != 0) continue;
      Mueller nearest;
      std::copy_n(answers.numbers.begin() + static_cast<std::ptrdiff_t>(17 * q), 16, nearest.elements.begin());
      const double change = answers.numbers[17 * q + 16];
      if (nearest == matrices[q]) {
        ASSERT_EQ(change, 0);
        continue;
      }
      ++moved;
      double squares = 0;
      for (std::size_t e = 0; e < 16; ++e) squares += std::pow(nearest.elements[e] - matrices[q].elements[e], 2);
      const bool squares_are_finite = largest(matrices[q]) < 1e100 && largest(matrices[q]) > 1e-100;
      ASSERT_NEAR(change, squares_are_finite ? std::sqrt(squares) : change, 1e-14 * largest(matrices[q]));
      ASSERT_EQ(nearest(0, 0), matrices[q](0, 0));
      ASSERT_EQ(ask(*kernel, Analysis::realizable, {nearest}).numbers[0], 1);
    }
    EXPECT_GT(moved, 500);
  }
}

TEST(AnalysisKernel, LeavesToTheRuleOfRanksWhatIsOfRankTwo) {
  for (const AnalysisKernel* kernel : kernels_that_run_here())
    for (const double sigma : {1e-14, 3e-16, 3e-20})
      for (const double others : {1.0, 1e-3, 1e-6, 1e-9}) {
        const Answers answers = ask(*kernel, Analysis::lu_chipman, {diagonal(1, others, others, -sigma)});
        EXPECT_EQ(answers.left[0], 1) << kernel->name << " " << others;
      }
}

TEST(AnalysisBatch, GivesTheSameFactorsInAnyUnit) {
  RandomMueller source(21);
  const Mueller other = diagonal(1, 0, 0, 0) + source.pure(3) + source.pure(3) * diagonal(1, 0.5, 0.2, 0.1);
  for (const double scale : {1e-300, 1e-150, 1e-100, 1e100, 1e121, 1e150, 1e300}) {
    const Mueller m = diagonal(1, 1e-9, 1e-9, -3e-16);
    EXPECT_LT(largest(lu_chipman(scale * m).retarder - lu_chipman(m).retarder), 1e-12) << scale;
    const SymmetricDecomposition f = symmetric_decomposition(other), scaled = symmetric_decomposition(scale * other);
    EXPECT_LT(largest(scaled.diattenuator1 - f.diattenuator1), 1e-11) << scale;
    EXPECT_LT(largest((1 / scale) * scaled.depolarizer - f.depolarizer), 1e-11) << scale;
  }
}

TEST(AnalysisBatch, KeepsLengthsWhoseSquaresAreNoNumbers) {
  for (const double tiny : {1e-300, 1e-170, 1e-161, 1e-5}) {
    Mueller m = diagonal(1, 0, 0, 0);
    m(0, 1) = m(1, 0) = 3 * tiny, m(0, 3) = m(3, 0) = 4 * tiny;
    EXPECT_NEAR(diattenuation(m) / tiny, 5, 1e-14);
    EXPECT_NEAR(polarizance(m) / tiny, 5, 1e-14);
    Mueller beside = diagonal(tiny, 0, 1, 0);  // cannot exist, but has a diattenuation
    beside(0, 1) = 0.6 * tiny;
    EXPECT_NEAR(diattenuation(beside), 0.6, 1e-14);
  }
  Mueller m = diagonal(0x1p-1010, 0, 0, 0);
  m(0, 1) = 1;
  EXPECT_NEAR(diattenuation(m) / 0x1p1010, 1, 1e-14);
  EXPECT_NEAR(realizability_margin(m) / 0x1p1010, -0.25, 1e-12);
}

TEST(AnalysisBatch, MultipliesPolarizersOfNearlyTheSameLightBack) {
  for (double t = 1e-3; t > 1e-12; t /= 3) {
    Mueller m;
    const double p[4] = {1, std::cos(t), std::sin(t), 0}, d[4] = {1, 1, 0, 0};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) m(i, j) = p[i] * d[j] / 2;
    const LuChipman f = lu_chipman(m);
    EXPECT_LE(largest(f.depolarizer * f.retarder * f.diattenuator - m), lu_chipman_error * m(0, 0)) << t;
  }
}

TEST(AnalysisBatch, NeverMakesInfinityOfTheLargestNumbers) {
  constexpr double x = std::numeric_limits<double>::max();
  const Mueller m{{x, 0, -x, 0, 0, x, 0, 0, 0, x, 0, -x, -x, 0, x, 0}};
  for (const double element : nearest_realizable(m).matrix.elements) EXPECT_TRUE(std::isfinite(element));
}

TEST(AnalysisBatch, GivesEachMatrixTheBitsThatItHasAloneOnAnyNumberOfThreads) {
  const std::vector<Mueller> matrices = realizable_matrices(10000, 15);
  for (const int threads : {1, 3}) {
    std::vector<double> entropies(matrices.size());
    std::vector<LuChipman> factors(matrices.size());
    const auto is = std::make_unique<bool[]>(matrices.size());
    EXPECT_EQ(entropy(matrices, entropies, {.threads = threads}), 0U);
    EXPECT_EQ(lu_chipman(matrices, factors, {.threads = threads}), 0U);
    EXPECT_EQ(realizable(matrices, {is.get(), matrices.size()}, {.threads = threads}), 0U);
    for (std::size_t q = 0; q < matrices.size(); ++q) {
      ASSERT_TRUE(same_bits(entropies[q], entropy(matrices[q])));
      ASSERT_EQ(is[q], realizable(matrices[q]));
      const LuChipman alone = lu_chipman(matrices[q]);
      ASSERT_EQ(factors[q].depolarizer, alone.depolarizer);
      ASSERT_EQ(factors[q].retarder, alone.retarder);
      ASSERT_EQ(factors[q].diattenuator, alone.diattenuator);
    }
  }
}

TEST(AnalysisBatch, GivesTheSymmetricFactorsTheBitsThatTheyHaveAlone) {
  const std::vector<Mueller> matrices = realizable_matrices(3000, 20);
  std::vector<SymmetricDecomposition> factors(matrices.size());
  const MatricesOptions options{.threads = 3, .refused = Refused::nan};
  std::size_t refused = symmetric_decomposition(matrices, factors, options);
  for (std::size_t q = 0; q < matrices.size(); ++q) {
    const SymmetricDecomposition& f = factors[q];
    if (std::isnan(f.depolarizer(0, 0))) {
      EXPECT_THROW(symmetric_decomposition(matrices[q]), std::invalid_argument);
      --refused;
      continue;
    }
    const SymmetricDecomposition alone = symmetric_decomposition(matrices[q]);
    ASSERT_EQ(f.diattenuator2, alone.diattenuator2);
    ASSERT_EQ(f.retarder2, alone.retarder2);
    ASSERT_EQ(f.depolarizer, alone.depolarizer);
    ASSERT_EQ(f.retarder1, alone.retarder1);
    ASSERT_EQ(f.diattenuator1, alone.diattenuator1);
  }
  EXPECT_EQ(refused, 0U);
}

TEST(AnalysisBatch, GivesRatiosTheBitsThatEachHasAlone) {
  RandomMueller source(22);
  std::vector<Mueller> matrices = with_noise(realizable_matrices(3000, 23), 24);
  for (std::size_t q = 0; q < matrices.size(); q += 3) matrices[q] = source.anything();
  std::vector<Ratios> all(matrices.size());
  EXPECT_LT(ratios(matrices, all, {.refused = Refused::nan}), matrices.size() / 2);
  for (std::size_t q = 0; q < matrices.size(); ++q) {
    const Mueller& m = matrices[q];
    if (std::isnan(all[q].purity)) {
      EXPECT_THROW(ratios(m), std::invalid_argument);
      continue;
    }
    for (const Ratios& r : {all[q], ratios(m)}) {
      ASSERT_TRUE(same_bits(r.depolarization, depolarization(m)));
      ASSERT_TRUE(same_bits(r.diattenuation, diattenuation(m)));
      ASSERT_TRUE(same_bits(r.polarizance, polarizance(m)));
      ASSERT_TRUE(same_bits(r.purity, purity(m)));
      ASSERT_TRUE(same_bits(r.realizability_margin, realizability_margin(m)));
      ASSERT_TRUE(same_bits(r.entropy, entropy(m)));
    }
  }
}

TEST(AnalysisBatch, NamesTheFirstMatrixThatIsRefusedAndHowManyAre) {
  std::vector<Mueller> matrices = realizable_matrices(9000, 16);
  matrices[4321](0, 0) = -1;
  matrices[8000](2, 3) = not_a_number;
  std::vector<double> out(matrices.size());
  try {
    purity(matrices, out, {.threads = 2});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "matrix 4321, counted from 0: M11 = -1, must be positive (2 of 9000 are refused)");
  }
}

TEST(AnalysisBatch, MakesNanOfWhatIsRefusedWhereThatIsAsked) {
  std::vector<Mueller> matrices = realizable_matrices(100, 17);
  matrices[30](0, 0) = 0;
  matrices[70](1, 1) = not_a_number;
  const MatricesOptions options{.refused = Refused::nan};
  std::vector<double> out(100);
  std::vector<LuChipman> factors(100);
  const auto is = std::make_unique<bool[]>(100);
  EXPECT_EQ(depolarization(matrices, out, options), 2U);
  EXPECT_EQ(lu_chipman(matrices, factors, options), 2U);
  EXPECT_EQ(realizable(matrices, {is.get(), 100}, options), 1U);
  for (std::size_t q = 0; q < 100; ++q) {
    const bool refused = q == 30 || q == 70;
    EXPECT_EQ(std::isnan(out[q]), refused);
    EXPECT_EQ(std::isnan(factors[q].retarder(0, 0)), refused);
    EXPECT_EQ(is[q], !refused);
  }
}

TEST(AnalysisBatch, RefusesRoomForAnotherNumberOfResults) {
  const std::vector<Mueller> matrices(3, identity());
  std::vector<double> out(2);
  EXPECT_THROW(entropy(matrices, out), std::invalid_argument);
}

}  // namespace
