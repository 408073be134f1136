// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/model/moments.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

/// Of any family that does not depend on how the sample is turned.
PreparedModel turnable() {
  const Family family = *rc::gen::element(Family::isotropic, Family::germer2017);
  const Orders orders{*rc::gen::inRange(0, 9), *rc::gen::inRange(0, 7)};
  const DiscMapping mapping = *rc::gen::element(DiscMapping::lambert, DiscMapping::projected);
  return prepare(
      random_model(family, orders, *rc::gen::inRange(0, 2), *rc::gen::inRange<std::uint64_t>(1, 1000), mapping), 0.5);
}

/// From the normal to the horizon, both included.
double cosine() { return *rc::gen::inRange(0, 11) * 0.1; }

double largest(const Mueller& m) {
  double result = 0;
  for (const double e : m.elements) result = std::max(result, std::abs(e));
  return result;
}

RC_GTEST_PROP(Moments, ResumToTheModelAtAnyAzimuths, ()) {
  const PreparedModel model = turnable();
  const double mu_i = cosine(), mu_r = cosine(), phi_i = between(-7, 7), phi_r = between(-7, 7);
  const Mueller expected = model.evaluate({{std::acos(mu_i), phi_i}, {std::acos(mu_r), phi_r}}, Frame::sp);
  const Mueller found = resummed(fourier_moments(model, mu_i, mu_r), phi_r - phi_i);
  // Random models have elements up to some times f11.
  RC_ASSERT(largest(found - expected) <= moment_error * std::max(std::abs(expected(0, 0)), largest(expected)));
}

/// The largest change of an element, as a part of f11, in the mirror image.
double handedness(const PreparedModel& model, double mu_i, double mu_r, double phi) {
  const Mueller one = model.evaluate({{std::acos(mu_i), 0}, {std::acos(mu_r), phi}}, Frame::sp),
                other = model.evaluate({{std::acos(mu_i), 0}, {std::acos(mu_r), -phi}}, Frame::sp);
  double result = 0;
  for (std::size_t e = 0; e < 16; ++e) {
    const bool odd = (e / 4 < 2) != (e % 4 < 2);
    result = std::max(result, std::abs(other.elements[e] - (odd ? -1 : 1) * one.elements[e]));
  }
  return result / std::max(std::abs(one(0, 0)), largest(one));
}

RC_GTEST_PROP(Moments, AreOfAModelThatIsItsOwnMirrorImage, ()) {
  const PreparedModel model = turnable();
  RC_ASSERT(is_its_own_mirror_image(model));
  RC_ASSERT(handedness(model, cosine(), cosine(), between(-4, 4)) <= moment_error);
}

TEST(Moments, OfAHandedModelAreNotThoseOfItsMirrorImage) {
  const PreparedModel model = prepare(handed(), 0.5);
  EXPECT_FALSE(is_its_own_mirror_image(model));
  EXPECT_GT(handedness(model, 0.6, 0.4, 0.7), 0.01);
  const FourierMoments moments = fourier_moments(model, 0.6, 0.4);
  for (const double phi : {0.7, -0.7}) {
    const Mueller expected = model.evaluate({{std::acos(0.6), 0}, {std::acos(0.4), phi}}, Frame::sp);
    EXPECT_LE(largest(resummed(moments, phi) - expected), moment_error * expected(0, 0));
  }
  EXPECT_THROW(is_its_own_mirror_image(prepare(random_model(Family::anisotropic, {2, 1}, 0, 1), 0.5)),
               std::invalid_argument);
}

RC_GTEST_PROP(Moments, AreTheIntegralsOfTheModelOverTheCircle, ()) {
  const PreparedModel model = turnable();
  const double mu_i = cosine(), mu_r = cosine();
  const FourierMoments moments = fourier_moments(model, mu_i, mu_r);
  constexpr int azimuths = 64;  // exact for degrees below 32
  std::vector<Mueller> f;
  for (int a = 0; a < azimuths; ++a)
    f.push_back(model.evaluate({{std::acos(mu_i), 0}, {std::acos(mu_r), 2 * pi * a / azimuths}}, Frame::sp));
  double size = 0;
  for (const Mueller& one : f) size = std::max(size, largest(one));
  RC_ASSERT(moments.cosine.size() == static_cast<std::size_t>(highest_moment(model)) + 1);
  for (int m = 0; m < azimuths / 2; ++m) {
    Mueller c{}, s{};
    for (int a = 0; a < azimuths; ++a) {
      const double weight = (m == 0 ? 1.0 : 2.0) / azimuths, angle = 2 * pi * a * m / azimuths;
      c = c + weight * std::cos(angle) * f[static_cast<std::size_t>(a)];
      s = s + weight * std::sin(angle) * f[static_cast<std::size_t>(a)];
    }
    const auto at = static_cast<std::size_t>(m);
    const bool there = at < moments.cosine.size();
    RC_ASSERT(largest(c - (there ? moments.cosine[at] : Mueller{})) <= moment_error * size);
    RC_ASSERT(largest(s - (there ? moments.sine[at] : Mueller{})) <= moment_error * size);
  }
}

RC_GTEST_PROP(Moments, AreThoseOfTheExchangedPairWithTheSignsOfReciprocity, ()) {
  const PreparedModel model =
      prepare(random_model(Family::isotropic, {5, 4}, 1, *rc::gen::inRange<std::uint64_t>(1, 1000)), 0.5);
  const double mu_i = cosine(), mu_r = cosine();
  const FourierMoments there = fourier_moments(model, mu_i, mu_r), back = fourier_moments(model, mu_r, mu_i);
  for (std::size_t m = 0; m < there.cosine.size(); ++m) {  // f(i, r, φ) = A f(r, i, −φ)ᵀ A
    const double size = largest(there.cosine[0]);
    RC_ASSERT(largest(there.cosine[m] - exchanged(back.cosine[m])) <= moment_error * size);
    RC_ASSERT(largest(there.sine[m] + exchanged(back.sine[m])) <= moment_error * size);
  }
}

RC_GTEST_PROP(Moments, AreCosinesWithinAndSinesBetweenTheHalvesOfAStokesVector, ()) {
  const FourierMoments moments = fourier_moments(turnable(), cosine(), cosine());
  const double size = largest(moments.cosine[0]);
  for (std::size_t m = 0; m < moments.cosine.size(); ++m)  // M(−φ) = P M(φ) P
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        RC_ASSERT(std::abs(((row < 2) == (column < 2) ? moments.sine : moments.cosine)[m](row, column)) <=
                  moment_error * size);
}

TEST(Moments, AreFourteenOfThePublishedOrdersAndOneOfAPerfectDiffuser) {
  EXPECT_EQ(highest_moment(prepare(material("ptfe"), 0.532)), 13);  // 7 + 4 + 2
  const PreparedModel perfect = prepare(diffuser({1 / pi}), 0.5);
  EXPECT_EQ(highest_moment(perfect), 0);
  const FourierMoments moments = fourier_moments(perfect, 0.3, 0.8);
  EXPECT_EQ(moments.cosine.size(), 1U);
  EXPECT_NEAR(pi * moments.cosine[0](0, 0), 1, 1e-15);
}

TEST(Moments, ComeForAllPairsWithTheSourceRisingFastest) {
  const PreparedModel model = prepare(material("ptfe"), 0.532);
  const std::vector<double> sources{0.2, 0.5, 1}, views{0, 0.9};
  const std::vector<FourierMoments> all = fourier_moments(model, sources, views);
  ASSERT_EQ(all.size(), 6U);
  for (std::size_t r = 0; r < 2; ++r)
    for (std::size_t i = 0; i < 3; ++i) {
      const FourierMoments one = fourier_moments(model, sources[i], views[r]);
      EXPECT_EQ(all[r * 3 + i].cosine, one.cosine);
      EXPECT_EQ(all[r * 3 + i].sine, one.sine);
    }
}

TEST(Moments, OfElementsThatWereNotMeasuredAreUnknown) {
  Model model = random_model(Family::isotropic, {3, 2}, 0, 1);
  std::erase_if(model.blocks, [](const FittedBlock& fitted) { return fitted.block.name.ends_with("34,42,43"); });
  ASSERT_EQ(model.blocks.size(), 5U);
  for (const int index : {7, 11, 13, 14}) model.not_measured.set(static_cast<std::size_t>(index));
  const FourierMoments moments = fourier_moments(prepare(model, 0.5), 0.3, 0.8);
  for (const std::vector<Mueller>* part : {&moments.cosine, &moments.sine})
    for (const Mueller& m : *part) EXPECT_EQ(unknown_elements(m), unknown_elements(model, Frame::sp));
}

TEST(Moments, AreRefusedWhereTheyWouldDependOnTheAzimuthOfTheSource) {
  const PreparedModel anisotropic = prepare(random_model(Family::anisotropic, {2, 1}, 0, 1), 0.5);
  const PreparedModel printed = prepare(as_printed(random_model(Family::germer2017, {2, 2}, 0, 1)), 0.5);
  for (const PreparedModel& model : {anisotropic, printed}) {
    EXPECT_NE(message_of([&] { fourier_moments(model, 0.5, 0.5); }).find("depends on the azimuth of the source"),
              std::string::npos);
    EXPECT_THROW(highest_moment(model), std::invalid_argument);
  }
}

TEST(Moments, AreRefusedAtWhatIsNoCosine) {
  const PreparedModel model = prepare(material("ptfe"), 0.532);
  for (const double mu : {-0.1, 1.0000001, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_NE(message_of([&] { fourier_moments(model, mu, 0.5); }).find("mu_incident = "), std::string::npos);
    EXPECT_NE(message_of([&] { fourier_moments(model, 0.5, mu); }).find("mu_reflected = "), std::string::npos);
  }
}

}  // namespace
}  // namespace mmbrdf
