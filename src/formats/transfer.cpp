// SPDX-License-Identifier: BSD-3-Clause
#include "formats/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

std::vector<Node> stream_cosines(int streams) {
  std::vector<Node> nodes = gauss_legendre(streams);
  std::ranges::reverse(nodes);
  return nodes;
}

int moments_carried(int asked, int streams) {
  if (asked < 0)
    throw std::invalid_argument(std::to_string(asked) + " moments: must be 1 to " + std::to_string(2 * streams) +
                                ", or 0 for all that the quadrature carries");
  if (asked > 2 * streams)
    throw std::invalid_argument(std::to_string(asked) + " moments: a quadrature of " + std::to_string(streams) +
                                " cosines in each hemisphere carries at most " + std::to_string(2 * streams) +
                                ", m = 0 to " + std::to_string(2 * streams - 1));
  return asked == 0 ? 2 * streams : asked;
}

void require_polar_angles(std::span<const double> angles, const std::string& name) {
  for (const double angle : angles)
    if (!(angle >= 0 && angle <= radians(90)))
      throw std::invalid_argument(name + " = " + shortest(in_degrees(angle)) + " degrees, must be in 0...90");
}

void require_azimuths(std::span<const double> azimuths) {
  for (const double azimuth : azimuths)
    if (!(std::abs(in_degrees(azimuth)) <= 360))
      throw std::invalid_argument("an azimuth = " + shortest(in_degrees(azimuth)) + " degrees, must be in -360...360");
}

}  // namespace mmbrdf
