// SPDX-License-Identifier: BSD-3-Clause
// Model files: what is read is written, read again as the same, and usable.
#include "fuzz.hpp"
#include "mmbrdf/files/model_file.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto model = fuzz::unless_refused([&] { return model_from_json(fuzz::text_of(data, size), "input"); });
  if (!model) return 0;
  const std::string written = to_json(*model);
  fuzz::require(to_json(model_from_json(written, "written")) == written, "what is written reads as the same");
  fuzz::require_usable(*model);
  return 0;
}
