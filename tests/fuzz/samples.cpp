// SPDX-License-Identifier: BSD-3-Clause
// Samples, and small fits of what was read.
#include "fuzz.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"

using namespace mmbrdf;

namespace {
constexpr std::size_t few = 200;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto samples = fuzz::unless_refused([&] {
    std::istringstream in(fuzz::text_of(data, size));
    return read_samples(in, "input");
  });
  if (!samples) return 0;
  std::stringstream written;
  write_samples(written, *samples);
  fuzz::require(read_samples(written, "written").size() == samples->size(), "what is written has as many samples");
  if (samples->empty() || samples->size() > few) return 0;
  FitOptions options;
  options.minimum_norm = true;
  if (const auto fitted = fuzz::unless_refused([&] { return fit(*samples, {Family::isotropic, {1, 1}}, options); }))
    fuzz::require_usable(fitted->model);
  return 0;
}
