// SPDX-License-Identifier: BSD-3-Clause
// Models as tables of other programs: whatever model is read, a table is refused or written, and what our own readers
// know of what was written is samples. NetCDF is left to its library.
#include <vector>

#include "memory_file.hpp"
#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/formats/export.hpp"
#include "mmbrdf/formats/foreign.hpp"

using namespace mmbrdf;

namespace {

constexpr std::size_t most_modes = 400;  // of all blocks and powers: more is time, not another case

std::size_t modes(const Model& model) {
  std::size_t result = 0;
  for (const FittedBlock& block : model.blocks) result += block.coefficients.size();
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const auto model = fuzz::unless_refused([&] { return model_from_json(fuzz::text_of(data + 1, size - 1), "input"); });
  if (!model || modes(*model) > most_modes) return 0;
  const ExportFormat& format = export_formats()[data[0] % export_formats().size()];
  ExportOptions options;
  options.error = 1e3;  // the coarsest table will do
  if (format.takes_transfer) options.transfer = {2, 0, {0.5}, {0.3}, {1}};
  if (known_wavelengths(*model).empty()) options.wavelengths = {0.532};
  const auto table = fuzz::unless_refused([&] { return Export(*model, format, options); });
  if (!table) return 0;
  fuzz::require(table->understood().find("nan") == std::string::npos, "a table says numbers");
  std::ostringstream out;
  table->write(out);
  const std::string bytes = out.str();
  fuzz::require(!bytes.empty(), "a table is written");
  if (const std::string known = foreign_format(bytes, bytes.size()); known.empty() || known == "a NetCDF file")
    return 0;
  const fuzz::MemoryFile input(bytes);
  ForeignOptions told;
  std::vector<Sample> samples;
  const auto read = [&] {
    samples.clear();
    ForeignFile(input.path(), told).read([&](std::span<const Sample> some) {
      samples.insert(samples.end(), some.begin(), some.end());
    });
  };
  try {
    read();
  } catch (const std::runtime_error&) {  // the format has no place for wavelengths
    told.wavelengths = options.wavelengths.empty() ? known_wavelengths(*model) : options.wavelengths;
    read();
  }
  require_valid(samples);
  fuzz::require(!samples.empty(), "what is written has samples");
  return 0;
}
