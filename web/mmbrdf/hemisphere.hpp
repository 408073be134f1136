// SPDX-License-Identifier: BSD-3-Clause
/// Pictures of the sixteen elements over the hemisphere of reflected directions, for one incident direction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mmbrdf/model/prepared.hpp"

namespace mmbrdf::web {

/// Sixteen square tiles, four in a row, of pixels × pixels. In each a disc: x to the right and y upwards, in direction
/// cosines, or with `lambert` in the projection that keeps solid angles (radius √2 sin(θ/2)).
class Hemisphere {
 public:
  /// Throws std::invalid_argument unless 8 ≤ pixels ≤ 2048.
  Hemisphere(int pixels, bool lambert);

  /// All elements at the directions of the discs, in single precision (single_precision_error), in the frame and the
  /// convention asked for; `divided`: all but f11 divided by it. And where the model extrapolates.
  void evaluate(const PreparedModel& model, const Direction& incident, Frame frame, StokesConvention convention,
                bool divided);

  /// Makes of what was evaluated its difference from what the first one has: this − first, to the single precision of both.
  /// Beyond the range is what is so of either. Throws std::invalid_argument unless both have the same directions.
  void subtract(const Hemisphere& first);

  /// Smallest and largest of each element, 32 numbers.
  void extremes(float* out) const;

  /// The image of what was evaluated: colors() from the lower to the upper of limits(), lighter or darker stripes where
  /// the model extrapolates.
  void paint();

  std::size_t count() const { return x_.size(); }  ///< of directions in a disc
  float* values() { return values_.data(); }       ///< element after element, one for each direction
  float* limits() { return limits_.data(); }       ///< lower and upper of each element
  /// RGBA: 256 for f11, 256 for the others; the same for stripes; and one for what was not measured.
  std::uint32_t* colors() { return colors_.data(); }
  std::uint32_t* image() { return image_.data(); }  ///< RGBA, 4 pixels × 4 pixels
  const std::uint32_t* positions() const {
    return at_.data();
  }  ///< of the directions in the tile, row × 4 pixels + column

 private:
  std::size_t pixels_;
  bool lambert_;
  void evaluate_elements(const PreparedIncidence& at, Frame frame, StokesConvention convention, bool divided);

  /// Directions that are side by side in a row of the tile.
  struct Row {
    std::size_t first, count;
  };
  std::vector<Row> rows_;
  std::vector<float> x_, y_, z_, values_;
  std::vector<std::uint32_t> at_;
  std::vector<std::uint32_t> cell_;     // of each direction
  std::vector<std::uint16_t> stripes_;  // of each direction: what is added to the number of its colour beyond the range
  std::vector<Direction> cells_;        // few directions: range is asked of them alone
  std::vector<std::uint16_t> outside_;  // of each cell: all bits, or none
  std::array<float, 32> limits_{};
  std::array<std::uint32_t, 1025> colors_{};
  std::vector<std::uint32_t> image_;
};

}  // namespace mmbrdf::web
