// SPDX-License-Identifier: BSD-3-Clause
// Instruments.
#include "fuzz.hpp"
#include "mmbrdf/files/instrument_file.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto instrument =
      fuzz::unless_refused([&] { return calibration_from_json(fuzz::text_of(data, size), "input"); });
  if (!instrument) return 0;
  const std::string written = to_json(*instrument);
  fuzz::require(to_json(calibration_from_json(written, "written")) == written, "what is written reads as the same");
  return 0;
}
