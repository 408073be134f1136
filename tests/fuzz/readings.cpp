// SPDX-License-Identifier: BSD-3-Clause
// Readings of references and of samples: the first byte says which.
#include "fuzz.hpp"
#include "mmbrdf/files/readings_file.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::istringstream in(fuzz::text_of(data + 1, size - 1));
  if (data[0] % 2 == 0) {
    const auto file = fuzz::unless_refused([&] { return read_references(in, "input"); });
    if (!file) return 0;
    std::stringstream written;
    write_references(written, *file);
    fuzz::require(read_references(written, "written").states == file->states, "what is written has the same states");
    return 0;
  }
  fuzz::unless_refused([&] {
    RawReader reader(in, "input", {4, 4});
    RawMeasurement measurement;
    long count = 0;
    while (reader.next(measurement)) ++count;
    return count;
  });
  return 0;
}
