// SPDX-License-Identifier: BSD-3-Clause
// Evaluates a built-in material: the BRDF of sintered PTFE at 532 nm for light that arrives at 45 degrees.

#include <mmbrdf/files/materials.hpp>
#include <mmbrdf/geometry/geometry.hpp>
#include <mmbrdf/model/prepared.hpp>

#include <cstdio>

int main() {
  using mmbrdf::radians;
  const mmbrdf::Model ptfe = mmbrdf::material("ptfe");
  const mmbrdf::PreparedModel at_532_nm = mmbrdf::prepare(ptfe, 0.532);

  std::puts("theta_r_deg,f11");
  for (const double theta_r_deg : {0.0, 20.0, 40.0, 60.0}) {
    const mmbrdf::Geometry geometry{{radians(45), radians(0)}, {radians(theta_r_deg), radians(180)}};
    const mmbrdf::Mueller f = at_532_nm.evaluate(geometry, mmbrdf::Frame::xy);
    std::printf("%g,%.4f\n", theta_r_deg, f(0, 0));
  }
}
