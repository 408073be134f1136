// SPDX-License-Identifier: BSD-3-Clause
// Published coefficients.
#include "fuzz.hpp"
#include "mmbrdf/files/coefficients_file.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = fuzz::unless_refused([&] {
    std::istringstream in(fuzz::text_of(data, size));
    return read_coefficients(in, "input");
  });
  if (!model) return 0;
  std::istringstream written(to_coefficients_csv(*model));
  fuzz::require(to_coefficients_csv(read_coefficients(written, "written")) == to_coefficients_csv(*model),
                "what is written reads as the same");
  fuzz::require_usable(*model);
  return 0;
}
