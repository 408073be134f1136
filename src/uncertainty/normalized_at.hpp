// SPDX-License-Identifier: BSD-3-Clause
/// f11 and the other elements divided by it at some geometries, as the modes give them, with their covariances.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mmbrdf/polarization/covariance.hpp"
#include "uncertainty/block_at.hpp"

namespace mmbrdf {

struct NormalizedAt {
  struct Part {
    std::string name;
    std::vector<MuellerCovariance> covariances;  // at each geometry
  };
  std::vector<Mueller> m;
  std::vector<Part> parts;  // the first that of the fit
};

/// `order` and `mapping` are those of the rows of the blocks.
NormalizedAt normalized_at(std::span<const BlockAt> blocks, int order, DiscMapping mapping,
                           std::span<const Geometry> geometries);

/// "fit" of least squares, "posterior" of the mixed model.
std::string name_of_fit(std::span<const BlockAt> blocks);

}  // namespace mmbrdf
