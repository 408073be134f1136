// SPDX-License-Identifier: BSD-3-Clause
// Succeeds when an installed mmbrdf compiles, links and gives a plausible value: near 1/pi for sintered PTFE.

#include <mmbrdf/files/materials.hpp>
#include <mmbrdf/model/prepared.hpp>

int main() {
  const auto model = mmbrdf::material("ptfe");
  const auto prepared = mmbrdf::prepare(model, 0.532);
  const auto f = prepared.evaluate({{0.785398163397448, 0.0}, {0.0, 0.0}}, mmbrdf::Frame::xy);
  return f(0, 0) > 0.3 && f(0, 0) < 0.35 ? 0 : 1;
}
