// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the C++ library, which each test.* beside this prints through its interface.
#include <cstdio>
#include <numbers>
#include <vector>

#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/quantities/answer.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"

using namespace mmbrdf;

int main() {
  const Model model = material("ptfe");
  const PreparedModel prepared = prepare(model, 532.0 / 1000);
  const PreparedUncertainty u = prepare_uncertainty(model, 532.0 / 1000);
  const PreparedAnswers answers = Answers(model, {.parts = false}).at(532.0 / 1000);
  for (int q = 0; q < 3; ++q) {
    const double radian = std::numbers::pi / 180;
    const Geometry g{{(20.0 + 30 * q) * radian, 10 * radian}, {(70.0 - 30 * q) * radian, 100 * radian}};
    const Mueller m =
        convert(prepared.evaluate(g, Frame::sp), StokesConvention::germer2017, StokesConvention::p_first_right);
    std::printf("matrix");
    for (const double element : m.elements) std::printf(" %.17g", element);
    std::printf("\nuncertainty");
    for (const double element : u.standard_uncertainty(g, Frame::sp).elements) std::printf(" %.17g", element);
    const Answer answer = answers.at(std::vector{g}).front();
    for (const Answered& a : answer.quantities)
      if (a.quantity->name == "depolarization") std::printf("\ndepolarization %.17g %.17g", *a.value, *a.uncertainty);
    std::printf("\ndhr %.17g %.17g\noutside %d\n",
                directional_hemispherical_reflectance(model, 532.0 / 1000, g.incident),
                u.directional_hemispherical_reflectance(g.incident), static_cast<int>(prepared.outside(g)));
  }
}
