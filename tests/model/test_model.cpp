// SPDX-License-Identifier: BSD-3-Clause
// What a model must be, and where it is valid.
#include "mmbrdf/model/model.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "given/cases.hpp"
#include "given/random_model.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"

using namespace mmbrdf;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST(ReflectanceTable, IsLinearBetweenItsNodesAndConstantBeyond) {
  const ReflectanceTable table{{0.4, 0.5, 0.8}, {0.9, 0.7, 0.1}};
  EXPECT_EQ(table.at(0.4), 0.9);
  EXPECT_EQ(table.at(0.5), 0.7);
  EXPECT_EQ(table.at(0.8), 0.1);
  EXPECT_NEAR(table.at(0.45), 0.8, 1e-15);
  EXPECT_NEAR(table.at(0.7), 0.3, 1e-15);
  EXPECT_EQ(table.at(0.1), 0.9);
  EXPECT_EQ(table.at(50), 0.1);
  EXPECT_EQ((ReflectanceTable{{0.6}, {0.3}}).at(0.1), 0.3);
  EXPECT_EQ(ReflectanceTable{}.at(0.5), 1);
  for (const double wavelength : {0.1, 0.4, 0.45, 0.5, 0.7, 0.8, 50.0}) {
    const std::vector<double> weights = table.weights(wavelength);
    EXPECT_NEAR(std::inner_product(weights.begin(), weights.end(), table.values.begin(), 0.0), table.at(wavelength),
                1e-15);
  }
}

TEST(ReflectanceTable, ThatIsNoneIsRefused) {
  const auto refusal = [](const ReflectanceTable& table) {
    Model model = diffuser({1});
    model.reflectance = table;
    const std::string message = message_of([&] { require_valid(table); });
    EXPECT_EQ(message_of([&] { prepare(model, 1); }), message);
    return message;
  };
  EXPECT_EQ(refusal({{0.4, 0.5}, {1}}), "reflectance table: 2 wavelengths, 1 values");
  EXPECT_EQ(refusal({{0.5, 0.4}, {1, 1}}), "reflectance table: wavelength 400 nm does not rise");
  EXPECT_EQ(refusal({{0.5, 0.5}, {1, 1}}), "reflectance table: wavelength 500 nm does not rise");
  EXPECT_EQ(refusal({{0.5}, {0}}), "reflectance table: value 0 is not positive");
  EXPECT_EQ(refusal({{0.5}, {-1e-9}}), "reflectance table: value -1e-09 is not positive");
  EXPECT_EQ(refusal({{0.5}, {1.1e40}}), "reflectance table: value 1.1e+40 is not at most 1e+40");
  for (const double bad : {nan_value, infinity}) EXPECT_NE(refusal({{0.5}, {bad}}), "nothing was thrown");
  for (const double bad : {0.0, -0.5, nan_value, infinity}) EXPECT_NE(refusal({{bad}, {1}}), "nothing was thrown");
  EXPECT_EQ(refusal({}), "nothing was thrown");
}

TEST(ReflectanceTable, WhoseCovariancesDoNotFitItIsRefused) {
  const auto refusal = [](const ReflectanceTable& table) { return message_of([&] { require_valid(table); }); };
  const std::vector<double> at{0.4, 0.5, 0.6}, values{1, 1, 1};
  EXPECT_EQ(refusal({at, values, {1, 2, 3}}), "nothing was thrown");  // independent values
  EXPECT_EQ(refusal({at, values, std::vector<double>(9)}), "nothing was thrown");
  for (const std::size_t count : {1u, 2u, 4u, 8u, 10u})
    EXPECT_EQ(refusal({at, values, std::vector<double>(count)}),
              "reflectance table: covariance of " + std::to_string(count) + " numbers, expected 9");
  for (const double bad : {nan_value, infinity, 1.1e80})
    EXPECT_EQ(refusal({at, values, {1, bad, 1}}), "reflectance table: a covariance is not a number up to 1e+80");
  EXPECT_EQ(refusal({at, values, {}, {1}}),
            "reflectance table: a covariance with the coefficients, but none of its own");
  EXPECT_EQ(refusal({at, values, {1, 1, 1}, {nan_value}}),
            "reflectance table: a covariance is not a number up to 1e+80");
}

TEST(ReflectanceTable, IsCertifiedAtAPolarAngleBelowNinetyDegreesForEachValue) {
  ReflectanceTable table{{0.4, 0.5}, {1, 1}, {1, 1}};
  const auto refusal = [&](const std::vector<double>& theta) {
    table.certified_theta = theta;
    return message_of([&] { require_valid(table); });
  };
  const std::string message =
      "reflectance table: certified polar angles must be in [0, 90) degrees, one for each value";
  EXPECT_EQ(refusal({0, radians(89)}), "nothing was thrown");
  for (const std::vector<double>& wrong :
       std::vector<std::vector<double>>{{0.1}, {0.1, 0.1, 0.1}, {0.1, radians(90)}, {-1e-9, 0.1}, {0.1, nan_value}})
    EXPECT_EQ(refusal(wrong), message);
  table.covariance.clear();
  EXPECT_EQ(refusal({0, 0}), message);  // of what is certified the uncertainty is known
}

TEST(Model, OfOneWavelengthNeedsNone) {
  Model model = diffuser({1});
  EXPECT_EQ(only_wavelength(model), 1);
  model.validity.wavelengths = {0.532};
  EXPECT_EQ(only_wavelength(model), 0.532);
  model.reflectance = {{0.532}, {0.98}};
  EXPECT_EQ(only_wavelength(model), 0.532);
}

TEST(Model, OfSeveralWavelengthsNeedsOneAndSaysWhichItKnows) {
  Model linear = diffuser({1, 1});
  EXPECT_EQ(message_of([&] { only_wavelength(linear); }), "the model depends on the wavelength: give one");
  linear.validity.wavelengths = {0.351, 1.5505};
  EXPECT_EQ(message_of([&] { only_wavelength(linear); }),
            "the model depends on the wavelength, fitted at 351, 1550.5 nm: give one");
  Model scaled = diffuser({1});
  scaled.reflectance = {{0.4, 0.5}, {1, 0.5}};
  EXPECT_NE(message_of([&] { only_wavelength(scaled); }), "nothing was thrown");
}

TEST(Model, IsShownAtTheWavelengthsItKnows) {
  Model model = diffuser({1});
  EXPECT_EQ(known_wavelengths(model), (std::vector<double>{1}));  // any: it does not depend on it
  EXPECT_FALSE(knows_wavelength(model));
  EXPECT_EQ(known_wavelengths(diffuser({1, 1})), (std::vector<double>{}));
  model.reflectance = {{0.4, 0.5}, {1, 0.5}};
  EXPECT_EQ(known_wavelengths(model), (std::vector<double>{0.4, 0.5}));
  EXPECT_TRUE(knows_wavelength(model));
  model.validity.wavelengths = {0.45};
  EXPECT_EQ(known_wavelengths(model), (std::vector<double>{0.45}));
  EXPECT_TRUE(knows_wavelength(model));
}

TEST(Validity, FlagsEachRangeThatTheQuestionLeaves) {
  Model model = diffuser({1});
  model.validity = {{0.351, 0.532}, radians(75), radians(80)};
  const auto flags = [&](double wavelength, double theta_i, double theta_r) {
    const Geometry geometry = in_degrees(theta_i, 10, theta_r, 20);
    EXPECT_EQ(prepare(model, wavelength).outside(geometry), outside(model.validity, wavelength, geometry));
    return to_string(outside(model.validity, wavelength, geometry));
  };
  EXPECT_EQ(flags(0.4, 0, 0), "interpolated");
  EXPECT_EQ(flags(0.351, 75, 80), "ok");
  EXPECT_EQ(flags(0.532, 75, 80), "ok");
  EXPECT_EQ(flags(0.35, 0, 0), "wavelength");
  EXPECT_EQ(flags(0.533, 0, 0), "wavelength");
  EXPECT_EQ(flags(0.351, 75.001, 0), "theta_i");
  EXPECT_EQ(flags(0.532, 0, 80.001), "theta_r");
  EXPECT_EQ(flags(0.4, 89, 89), "theta_i+theta_r+interpolated");
  EXPECT_EQ(flags(1.064, 89, 89), "theta_i+theta_r+wavelength");
}

// 75° that went through radians and back, or 0.351 as 351/1000, are no reason for a warning.
TEST(Validity, IsNotLeftByARounding) {
  const Validity validity{{0.351}, radians(75), radians(75)};
  EXPECT_EQ(outside(validity, 0.351 + 0.9e-9, {{radians(75) + 0.9e-9, 0}, {radians(75) + 0.9e-9, 0}}), inside);
  EXPECT_EQ(outside(validity, 0.351 - 1.1e-9, {}), outside_wavelength);
}

TEST(Validity, ThatIsUnknownIsSaidToBe) {
  EXPECT_EQ(outside(Validity{}, 10, in_degrees(90, 0, 90, 0)), unknown_range);
  EXPECT_EQ(to_string(outside({{0.5}, {}, radians(75)}, 0.5, {})), "unknown");
  const Outside both = outside({{}, radians(75), radians(75)}, 0.5, in_degrees(80, 0, 0, 0));
  EXPECT_EQ(to_string(both), "theta_i+unknown");
  EXPECT_TRUE(leaves_known_range(both));
  EXPECT_FALSE(leaves_known_range(unknown_range));
}

TEST(Validity, OfAModelMustBeOne) {
  Model model = diffuser({1});
  for (const Validity& bad : {Validity{{0.5, 0.5}, {}, {}}, Validity{{-1}, {}, {}}, Validity{{}, radians(91), {}},
                              Validity{{}, {}, nan_value}}) {
    model.validity = bad;
    EXPECT_THROW(prepare(model, 0.5), std::invalid_argument);
  }
}

TEST(Model, HasTheDegreesOfFreedomOfTheBlockThatHasTheFewest) {
  Model model = random_model(Family::isotropic, {2, 2}, 0, 1);
  EXPECT_EQ(degrees_of_freedom(model), std::numeric_limits<double>::infinity());
  model.blocks[0].rows = 100;
  model.blocks[0].rank = 6;
  EXPECT_EQ(degrees_of_freedom(model), 94);
  model.blocks[1].rows = 20;
  model.blocks[1].rank = 20;
  EXPECT_EQ(degrees_of_freedom(model), 1);
}

TEST(ReflectanceTable, ReachesFromItsFirstNodeToItsLast) {
  const ReflectanceTable table{{0.4, 0.7}, {0.9, 0.9}};
  require_reaches(table, 0.4);
  require_reaches(table, 0.7 + 1e-8);
  require_reaches({}, 0.1);
  EXPECT_EQ(message_of([&] { require_reaches(table, 0.351); }), "the reflectance table does not reach 351 nm");
  EXPECT_THROW(require_reaches(table, 0.8), std::invalid_argument);
}

TEST(Model, KnowsItsOrdersAndCoefficients) {
  const Model model = random_model(Family::isotropic, {7, 4}, 1, 1);
  EXPECT_EQ(mode_count(model), 142);
  EXPECT_EQ(coefficient_count(model), 284);
  EXPECT_EQ(orders(model), (Orders{7, 4}));
  EXPECT_NO_THROW(require_valid(model));
}

TEST(Model, ThatDoesNotFitTogetherIsRefusedWithTheReason) {
  const Model good = random_model(Family::isotropic, {2, 2}, 1, 1);
  const auto refusal = [&](const std::function<void(Model&)>& spoil) {
    Model bad = good;
    spoil(bad);
    const std::string message = message_of([&] { require_valid(bad); });
    EXPECT_EQ(message_of([&] { prepare(bad, 0.5); }), message);
    return message;
  };
  ASSERT_EQ(good.blocks[2].block.name, "14,41");
  ASSERT_EQ(good.blocks[2].coefficients.size(), 4u);
  EXPECT_EQ(refusal([](Model& m) { m.blocks.clear(); }), "model has no modes of element 11");
  EXPECT_EQ(refusal([](Model& m) { m.blocks.erase(m.blocks.begin()); }), "model has no modes of element 11");
  EXPECT_EQ(refusal([](Model& m) { std::swap(m.blocks[1], m.blocks[2]); }),
            "block 14,41: modes are not in canonical order");
  EXPECT_EQ(refusal([](Model& m) { std::swap(m.blocks[1].block.modes[0], m.blocks[1].block.modes[1]); }),
            "block 12,13,21,31: modes are not in canonical order");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[1].block.elements.pop_back(); }),
            "block 12,13,21,31: modes are not in canonical order");
  EXPECT_EQ(refusal([](Model& m) { m.blocks.push_back({}); }), "model: modes are not in the blocks of the family");
  EXPECT_EQ(refusal([](Model& m) { m.blocks.push_back(m.blocks[2]); }),
            "mode 14 (n, m, k, l) = (1, 1, 1, -1) is given twice");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[0].block.modes[0].k = 1; }),
            "mode 11 (n, m, k, l) = (0, 0, 1, 0) of the isotropic family: |k| must not exceed n");
  EXPECT_NE(refusal([](Model& m) { m.family = Family::anisotropic; }), "nothing was thrown");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[2].coefficients.pop_back(); }), "block 14,41: 3 coefficients, expected 4");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[2].coefficients.push_back(0); }),
            "block 14,41: 5 coefficients, expected 4");
  EXPECT_NE(refusal([](Model& m) { m.powers = 0; }), "nothing was thrown");
  EXPECT_EQ(refusal([](Model& m) { m.powers = -1; }), "highest power of the wavelength -1 is not in 0...9");
  EXPECT_EQ(refusal([](Model& m) { m.powers = 10; }), "highest power of the wavelength 10 is not in 0...9");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[2].covariance.resize(15); }),
            "block 14,41: covariance of 15 numbers, expected 16");
  EXPECT_EQ(refusal([](Model& m) { m.blocks[2].covariance.resize(16); }), "nothing was thrown");
  for (const double bad : {nan_value, infinity, -infinity, 1.1e80, -1e300}) {
    EXPECT_EQ(refusal([&](Model& m) { m.blocks[2].coefficients[3] = bad; }),
              "block 14,41: a coefficient is not a number up to 1e+40");
    EXPECT_EQ(refusal([&](Model& m) { m.blocks[2].covariance.assign(16, bad); }),
              "block 14,41: a covariance is not a number up to 1e+80");
  }
  EXPECT_EQ(refusal([](Model& m) { m.blocks[2].rank = 4; }), "nothing was thrown");
  for (const int rank : {-1, 5})
    EXPECT_EQ(refusal([&](Model& m) { m.blocks[2].rank = rank; }),
              "block 14,41: rank " + std::to_string(rank) + " of 4");
  EXPECT_EQ(refusal([](Model& m) {
              m.blocks[2].covariance.resize(16);
              m.blocks[2].covariance[2 * 4 + 1] = 1e-9;
            }),
            "block 14,41: covariance is not symmetric at 3, 2");
  EXPECT_EQ(refusal([](Model& m) { m.not_measured.set(0); }), "model: f11 is said not to be measured");
  EXPECT_EQ(refusal([](Model& m) { m.not_measured.set(15); }),
            "model: elements are said not to be measured, but their block has modes");
  const auto with_f11 = [](std::size_t count) {
    return [=](Model& m) { m.reflectance = {{0.5, 0.6}, {1, 1}, {1, 1}, std::vector<double>(count)}; };
  };
  ASSERT_EQ(good.blocks[0].coefficients.size(), 10u);
  EXPECT_EQ(refusal(with_f11(20)), "nothing was thrown");
  for (const std::size_t count : {0u, 19u, 21u})
    EXPECT_EQ(refusal(with_f11(count)), "reflectance table: covariance with the coefficients of " +
                                            std::to_string(count) + " numbers, expected 20");
}

TEST(Model, IsRefusedWithAValidityThatIsNone) {
  Model model = random_model(Family::isotropic, {2, 2}, 1, 1);
  const auto refusal = [&](const Validity& validity) {
    model.validity = validity;
    return message_of([&] { require_valid(model); });
  };
  using Grid = DirectionPairs::Grid;
  const auto supported = [](std::vector<SupportedPairs> list) {
    Validity result;
    result.supported = std::move(list);
    return result;
  };
  const DirectionPairs isotropic(Grid::isotropic), anisotropic(Grid::anisotropic);
  EXPECT_EQ(refusal({{0.4, 0.5}, radians(90), 0, {}}), "nothing was thrown");
  EXPECT_EQ(refusal({{0.5, 0.4}, {}, {}, {}}), "validity: wavelength 400 nm does not rise");
  EXPECT_EQ(refusal({{0.5, 0.5}, {}, {}, {}}), "validity: wavelength 500 nm does not rise");
  EXPECT_EQ(refusal({{0.5}, radians(91), {}, {}}), "validity: polar angle 91 degrees is not in [0, 90]");
  EXPECT_EQ(refusal({{0.5}, {}, radians(-1), {}}), "validity: polar angle -1 degrees is not in [0, 90]");
  EXPECT_EQ(refusal(supported({{0.4, isotropic}, {0.5, isotropic}})), "nothing was thrown");
  for (const double second : {0.5, 0.4})
    EXPECT_EQ(refusal(supported({{0.5, isotropic}, {second, isotropic}})),
              "validity: wavelengths of the supported directions do not rise");
  EXPECT_EQ(refusal(supported({{0.4, isotropic}, {0.5, anisotropic}})),
            "validity: the supported directions are of different grids");
  EXPECT_EQ(refusal(supported({{0.4, anisotropic}})),
            "validity: the supported directions are on the grid of another family");
}

TEST(Model, BetweenWavelengthsSupportsWhatBothNeighboursDo) {
  const Geometry both = in_degrees(30, 0, 40, 90), one = in_degrees(60, 0, 10, 0);
  DirectionPairs few, more;
  for (const Geometry& geometry : {both, one}) more.add(geometry);
  few.add(both);
  const auto lacks = [](const Validity& validity, double wavelength, const Geometry& geometry) {
    return (outside(validity, wavelength, geometry) & outside_directions) != 0;
  };
  for (const bool below : {false, true}) {
    Validity validity{{0.4, 0.6}, {}, {}, {{0.4, below ? few : more}, {0.6, below ? more : few}}};
    for (const double wavelength : {0.4, 0.5, 0.6}) {
      EXPECT_FALSE(lacks(validity, wavelength, both)) << wavelength;
      EXPECT_EQ(lacks(validity, wavelength, one), wavelength != (below ? 0.6 : 0.4)) << wavelength;
    }
  }
}

TEST(Model, WithAPosteriorOfAnotherModelIsRefused) {
  const auto refusal = [](const std::function<void(Model&)>& spoil) {
    Model model = material("ptfe-532");
    spoil(model);
    return message_of([&] { require_valid(model); });
  };
  const std::string which = "the posterior of the model ";
  EXPECT_EQ(refusal([](Model&) {}), "nothing was thrown");
  EXPECT_EQ(refusal([](Model& m) { m.mapping = DiscMapping::projected; }), which + "has another mapping to the disc");
  EXPECT_EQ(refusal([](Model& m) { m.blocks.pop_back(); }), which + "has 6 blocks");
  EXPECT_EQ(refusal([](Model& m) {
              m.not_measured.set(15);
              m.blocks.pop_back();
            }),
            which + "is of other elements");
  EXPECT_EQ(refusal([](Model& m) {
              const std::size_t count = m.blocks[0].coefficients.size();
              m.blocks[0].covariance.assign(count * count, 0);
            }),
            which + "takes the place of a covariance, and there is one");
  EXPECT_EQ(refusal([](Model& m) {
              const auto posterior = m.posterior;
              m = random_model(Family::germer2017, {2, 2}, 0, 1);
              m.posterior = posterior;
            }),
            which + "is of the isotropic family, the model of germer2017");
  EXPECT_TRUE(refusal([](Model& m) {
                const auto posterior = m.posterior;
                m = random_model(Family::isotropic, {14, 4}, 0, 1);
                m.posterior = posterior;
              }).starts_with(which + "does not have the mode 11 "));
}

TEST(Model, IsOfOneWavelengthWhereNothingInItSaysMore) {
  const auto refusal = [](const std::function<void(Model&)>& change) {
    Model model = diffuser({1});
    model.reflectance = {};
    change(model);
    return message_of([&] { only_wavelength(model); });
  };
  EXPECT_EQ(refusal([](Model&) {}), "nothing was thrown");
  EXPECT_EQ(refusal([](Model& m) { m.validity.wavelengths = {0.5}; }), "nothing was thrown");
  EXPECT_EQ(refusal([](Model& m) {
              m.validity.wavelengths = {0.5, 0.6};
            }),
            "the model depends on the wavelength, fitted at 500, 600 nm: give one");
  EXPECT_EQ(refusal([](Model& m) {
              m.reflectance = {{0.5, 0.6}, {1, 1}};
            }),
            "the model depends on the wavelength: give one");
}
