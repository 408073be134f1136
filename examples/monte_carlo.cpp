// SPDX-License-Identifier: BSD-3-Clause
// Follows polarized light to sintered PTFE and back: its reflectance at 532 nm and 60 degrees by drawn directions, beside the integral.

#include <mmbrdf/files/materials.hpp>
#include <mmbrdf/model/sampling.hpp>
#include <mmbrdf/radiometry/reflectance.hpp>

#include <cmath>
#include <cstdio>

int main() {
  const mmbrdf::Model ptfe = mmbrdf::material("ptfe");
  const mmbrdf::DirectionSampler sampler(mmbrdf::prepare(ptfe, 0.532));
  const mmbrdf::Direction incident{mmbrdf::radians(60), 0};
  constexpr int count = 4096;

  std::puts("light,drawn,integral");
  for (const double s2 : {1.0, 0.0, -1.0}) {  // s-polarized, unpolarized, p-polarized
    const mmbrdf::Stokes light{1, s2, 0, 0};
    double reflected = 0;
    for (int i = 0; i < count; ++i) {
      // Any numbers in [0, 1) will do. These cover the square evenly: multiples of powers of 0.7549, where x³ + x² = 1.
      const double u1 = std::fmod(0.5 + 0.7548776662466927 * i, 1), u2 = std::fmod(0.5 + 0.5698402909980532 * i, 1);
      const mmbrdf::SampledDirection drawn = sampler.sample(incident, {u1, u2});
      const mmbrdf::Stokes scattered = sampler.weight(incident, drawn, mmbrdf::Frame::sp) * light;
      reflected += scattered[0] / count;  // a ray tracer would go on with this light, in this direction
    }
    const double integral = mmbrdf::directional_hemispherical_reflectance(ptfe, 0.532, incident, light);
    std::printf("%g,%.4f,%.4f\n", s2, reflected, integral);
  }
}
