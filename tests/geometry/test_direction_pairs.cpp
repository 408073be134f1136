// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/geometry/direction_pairs.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "given/cases.hpp"
#include "given/halton.hpp"

namespace mmbrdf {
namespace {

using Grid = DirectionPairs::Grid;

TEST(DirectionPairs, EachNodeButThoseAtANormalIsNextToItself) {
  for (const Grid grid : {Grid::isotropic, Grid::anisotropic}) {
    const DirectionPairs pairs(grid);
    for (std::size_t node = 0; node < pairs.nodes(); ++node) {
      const Geometry g = pairs.geometry(node);
      EXPECT_TRUE(g.incident.theta == 0 || g.reflected.theta == 0 || pairs.node(g) == node) << node;
    }
  }
}

TEST(DirectionPairs, NoneOtherThanThoseAddedAreThere) {
  for (const Grid grid : {Grid::isotropic, Grid::anisotropic}) {
    DirectionPairs pairs(grid);
    std::vector<bool> added(pairs.nodes());
    for (const Geometry& g : halton_directions(500, 0, 90)) {
      pairs.add(g);
      added[pairs.node(g)] = true;
      EXPECT_TRUE(pairs.contains(g));
    }
    for (std::size_t node = 0; node < added.size(); ++node) EXPECT_EQ(pairs.contains(node), added[node]);
    EXPECT_EQ(DirectionPairs(pairs.bytes()), pairs);
  }
}

TEST(DirectionPairs, OfIsotropicSamplesTurningTheSampleAndTheMirrorChangeNothing) {
  const DirectionPairs pairs;
  for (const auto& [i, r] : halton_directions(500, 0, 90))
    for (const double turn : {0.3, -2.0, 2 * std::numbers::pi}) {
      const std::size_t node = pairs.node({i, r});
      EXPECT_EQ(pairs.node({{i.theta, i.phi + turn}, {r.theta, r.phi + turn}}), node);
      EXPECT_EQ(pairs.node({{i.theta, -i.phi}, {r.theta, -r.phi}}), node);
      EXPECT_EQ(pairs.node({{0, i.phi}, r}), pairs.node({{0, i.phi + turn}, r}));  // no azimuth between them
      EXPECT_EQ(pairs.node({i, {0, r.phi}}), pairs.node({i, {0, r.phi + turn}}));
    }
}

TEST(DirectionPairs, OfOthersTheAzimuthOfTheSampleCounts) {
  const DirectionPairs pairs(Grid::anisotropic);
  EXPECT_NE(pairs.node({{1, 0}, {1, 1}}), pairs.node({{1, 1}, {1, 2}}));
  EXPECT_EQ(pairs.node({{1, -0.1}, {1, 6.2}}), pairs.node({{1, 0.1}, {1, 0}}));
  EXPECT_EQ(pairs.node({{1, 0}, {0, 1}}), pairs.node({{1, 0}, {0, 2}}));  // the normal has no azimuth
  EXPECT_EQ(pairs.node({{0, 1}, {1, 0}}), pairs.node({{0, 2}, {1, 0}}));
}

TEST(DirectionPairs, MergeToWhatEitherHasAndKeepWhatBothHave) {
  DirectionPairs a, b;
  for (const Geometry& g : halton_directions(300, 0, 60)) a.add(g);
  for (const Geometry& g : halton_directions(300, 40, 90)) b.add(g);
  DirectionPairs either = a, both = a;
  either.merge(b);
  both.keep(b);
  for (std::size_t node = 0; node < a.nodes(); ++node) {
    EXPECT_EQ(either.contains(node), a.contains(node) || b.contains(node));
    EXPECT_EQ(both.contains(node), a.contains(node) && b.contains(node));
  }
}

TEST(DirectionPairs, ReachAsFarAsNoneIsMissing) {
  DirectionPairs pairs;
  for (std::size_t node = 0; node < pairs.nodes(); ++node) {
    const Geometry g = pairs.geometry(node);
    if (g.incident.theta < radians(61) && g.reflected.theta < radians(71)) pairs.add(node);
  }
  EXPECT_TRUE(pairs.reach(radians(60), radians(70)));
  EXPECT_FALSE(pairs.reach(radians(65), radians(70)));
  EXPECT_FALSE(pairs.reach(radians(60), radians(75)));
}

TEST(DirectionPairs, OfNoGridAreRefused) {
  EXPECT_EQ(message_of([] { DirectionPairs(std::vector<std::uint8_t>(5)); }),
            "5 bytes are no set of pairs of directions");
  EXPECT_THROW(DirectionPairs().merge(DirectionPairs(Grid::anisotropic)), std::invalid_argument);
  EXPECT_EQ(message_of([] { DirectionPairs().keep(DirectionPairs(Grid::anisotropic)); }),
            "sets of pairs of directions of different grids");
}

}  // namespace
}  // namespace mmbrdf
