// SPDX-License-Identifier: BSD-3-Clause
#include "options/foreign.hpp"

#include <filesystem>

#include "mmbrdf/files/csv.hpp"
#include "mmbrdf/files/materials.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/files/write_file.hpp"
#include "mmbrdf/formats/foreign.hpp"
#include "options/arguments.hpp"
#include "options/files.hpp"

namespace mmbrdf::program {

bool is_foreign(const std::string& name) {
  for (const std::string& material : materials())
    if (material == name) return false;
  std::error_code ignored;
  return std::filesystem::is_regular_file(name, ignored) && !foreign_format(name).empty();
}

void write_as_samples(const std::string& input, const std::string& output,
                      const std::optional<std::vector<double>>& wavelengths_nm) {
  if (output == "-")
    throw WrongUsage("OUT", "\"-\": expected the name of a file; samples do not go to standard output");
  if (!has_ending(output, ".csv"))
    throw WrongUsage("OUT", "samples are written as CSV: expected a name that ends in .csv, not " + shown_name(output));
  require_kept(input, output, "measurement");
  ForeignFile file(input, {micrometres(wavelengths_nm.value_or(std::vector<double>{}))});
  write_file(output, [&](std::ostream& out) {
    SampleWriter writer(out, file.measured(), file.has_uncertainties(), file.has_frames());
    file.read([&](std::span<const Sample> samples) { writer.write(samples); });
  });
  note_written(output);
  note(data_name(input) + ": " + file.understood());
}

}  // namespace mmbrdf::program
