// SPDX-License-Identifier: BSD-3-Clause
// Files of geometries, CSV and .npy, as the program reads them.
#include "fuzz.hpp"
#include "streams/geometry_rows.hpp"

using namespace mmbrdf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::unless_refused([&] {
    std::istringstream in(fuzz::text_of(data, size));
    const program::GeometrySource source = program::open_geometries(in, "input", 0.532, true);
    std::size_t rows = 0;
    for (program::Piece piece; source.next(piece);) {
      const program::Rows some = source.rows(piece);
      for (const Geometry& g : some.geometries)
        fuzz::require(std::isfinite(g.incident.theta + g.incident.phi + g.reflected.theta + g.reflected.phi),
                      "geometries are finite");
      rows += some.size();
      if (some.error) break;
    }
    fuzz::require(rows <= size, "a row has a byte");
    return rows;
  });
  return 0;
}
