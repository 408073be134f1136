// SPDX-License-Identifier: BSD-3-Clause
// What is typed: apertures, ranges, directions, declared errors, targets of a plan. The first byte says which.
#include "fuzz.hpp"
#include "mmbrdf/mixed/plan.hpp"
#include "options/arguments.hpp"
#include "options/sides.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text = fuzz::text_of(data + 1, size - 1);
  fuzz::unless_refused([&]() -> int {
    switch (data[0] % 7) {
      case 0:
        for (const program::Side& side : {program::sides_from(text).source, program::sides_from(text).receiver})
          fuzz::require(std::isfinite(program::aperture_of(side, 0).projected_solid_angle()), "apertures are finite");
        break;
      case 1:
        for (const double number : program::range_from(text)) fuzz::require(std::isfinite(number), "ranges are finite");
        break;
      case 2:
        program::direction_degrees(text);
        break;
      case 3:
        program::declared_from(text);
        break;
      case 4:
        for (const NamedTarget& target : targets_from(text)) fuzz::require(!target.name.empty(), "targets have names");
        break;
      case 5:
        program::grid_from(text);
        break;
      default:
        fuzz::require(fuzz::all_finite(program::numbers(text)), "numbers are finite");
    }
    return 0;
  });
  return 0;
}
