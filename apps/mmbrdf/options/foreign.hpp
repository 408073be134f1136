// SPDX-License-Identifier: BSD-3-Clause
// Measurements in the formats of other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace mmbrdf::program {

/// Whether a name is that of a file in one of these formats, and of no built-in model.
bool is_foreign(const std::string& name);

/// Writes its samples as CSV, and a note of how it was understood. Throws std::runtime_error as ForeignFile does; then
/// nothing is written.
void write_as_samples(const std::string& input, const std::string& output,
                      const std::optional<std::vector<double>>& wavelengths_nm);

}  // namespace mmbrdf::program
