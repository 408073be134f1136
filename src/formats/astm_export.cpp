// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <ostream>

#include "formats/angle_table.hpp"
#include "formats/astm.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {

Export::Made make_astm(const Model& model, const ExportOptions& options) {
  const auto table = std::make_shared<const AngleTable>(model, options, "an ASTM");
  std::string head = "NUM_POINTS " + std::to_string(table->rows()) + "\nVARS theta_i,phi_i,theta_s,phi_s";
  for (const double wavelength : options.wavelengths) head += ',' + shortest(in_nanometres(wavelength)) + "nm";
  const auto write = [table, head](std::ostream& out) {
    out << head << '\n';
    table->each([&](const AngleTable::Row& row) {
      std::string line = rounded(row.theta_i, 8) + ",0," + rounded(row.theta_r, 8) + ',' + rounded(row.phi_r, 8);
      for (const double value : row.values) line += ',' + rounded(value, 8);
      out << line << '\n';
    });
  };
  return {write, table->error(), table->understood() + "; angles in radians"};
}

}  // namespace mmbrdf
