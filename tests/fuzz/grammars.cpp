// SPDX-License-Identifier: BSD-3-Clause
// What is typed: apertures, ranges, directions, declared errors, targets of a plan, terms, scans, certificates. The
// first byte says which.
#include "fuzz.hpp"
#include "mmbrdf/mixed/plan.hpp"
#include "options/arguments.hpp"
#include "options/certificate.hpp"
#include "options/scan.hpp"
#include "options/sides.hpp"
#include "options/terms.hpp"

using namespace mmbrdf;

namespace {

void require_certifies(const std::vector<CertifiedReflectance>& certificate) {
  for (const CertifiedReflectance& one : certificate)
    fuzz::require(fuzz::all_finite({{one.wavelength, one.value, one.uncertainty, one.theta}}),
                  "certificates are finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text = fuzz::text_of(data + 1, size - 1);
  fuzz::unless_refused([&]() -> int {
    switch (data[0] % 11) {
      case 0:
        for (const program::Side& side : {program::sides_from(text).source, program::sides_from(text).receiver})
          fuzz::require(std::isfinite(program::aperture_of(side, 0).projected_solid_angle()), "apertures are finite");
        break;
      case 1:
        for (const double number : program::range_from(text)) fuzz::require(std::isfinite(number), "ranges are finite");
        break;
      case 2:
        fuzz::require(std::isfinite(program::incident_degrees(text).theta), "sources are finite");
        program::reflected_degrees(text);
        break;
      case 3:
        program::declared_from(text);
        break;
      case 4:
        for (const NamedTarget& target : targets_from(text)) fuzz::require(!target.name.empty(), "targets have names");
        break;
      case 5:
        program::grid_from(text);
        break;
      case 6:
        for (const TypeBTerm& term : program::terms_from({{text}}))
          fuzz::require(std::isfinite(term.uncertainty) && term.freedom >= 1, "terms can be counted");
        break;
      case 7: {
        const program::Scan scan = program::scan_from(text);
        fuzz::require(scan.count >= 1 && scan.count <= program::max_scan_rows, "scans are bounded");
        fuzz::require(std::isfinite(scan.value(scan.count - 1)), "scans are finite");
        break;
      }
      case 8:
        if (text.find(':') != std::string::npos) require_certifies(program::certificate_from(text, {}));
        break;
      case 9: {
        std::istringstream in(text);
        require_certifies(program::read_certificate(in, "certificate.csv"));
        break;
      }
      default:
        fuzz::require(fuzz::all_finite(program::numbers(text)), "numbers are finite");
    }
    return 0;
  });
  return 0;
}
