// SPDX-License-Identifier: BSD-3-Clause
// Measurements in the formats of other programs. NetCDF is left to its library.
#include <string>

#include "memory_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/formats/foreign.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string bytes = fuzz::text_of(data + 1, size - 1);
  if (foreign_format(bytes, bytes.size()) == "a NetCDF file") return 0;
  const fuzz::MemoryFile input(bytes);
  ForeignOptions options;
  options.wavelengths.assign(data[0] % 4U, 0.5);
  std::vector<Sample> samples;
  std::stringstream written;
  const auto read = fuzz::unless_refused([&] {
    ForeignFile file(input.path(), options);
    SampleWriter writer(written, file.measured(), file.has_uncertainties(), file.has_frames());
    file.read([&](std::span<const Sample> some) {
      writer.write(some);
      samples.insert(samples.end(), some.begin(), some.end());
    });
    return file.understood();
  });
  if (!read) return 0;
  require_valid(samples);
  fuzz::require(!samples.empty() && read->find('\n') == std::string::npos, "a note of one line, and samples");
  fuzz::require(read_samples(written, "written").size() == samples.size(), "what is written has as many samples");
  return 0;
}
