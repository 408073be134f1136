// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <stdexcept>

#include "formats/export_table.hpp"
#include "formats/mqdiffuse.hpp"
#include "formats/new_netcdf.hpp"
#include "formats/reader.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

struct CosineCounts {
  std::size_t cosines, azimuths;
};
/// Cosines resolve the directions about the normal badly, which decides the error.
constexpr std::array<CosineCounts, 5> cosine_grids{{{31, 72}, {51, 72}, {101, 90}, {151, 180}, {201, 360}}};

std::string to_string(const CosineCounts& grid) {
  return std::to_string(grid.cosines) + " cosines of each direction and " + std::to_string(grid.azimuths) + " azimuths";
}

class CosineTable {
 public:
  CosineTable(const PreparedModel& model, const CosineCounts& grid, const Channel& value) : grid_(grid) {
    std::vector<Direction> reflected;
    std::vector<double> phi;
    for (std::size_t p = 0; p < grid.azimuths; ++p)
      phi_.push_back(4 * half_pi * static_cast<double>(p) / static_cast<double>(grid.azimuths));
    for (std::size_t k = 0; k < grid.cosines; ++k)
      mu_.push_back(static_cast<double>(k) / static_cast<double>(grid.cosines - 1));
    values_.resize(grid.cosines * grid.cosines * grid.azimuths);
    for (const double mu : mu_)
      for (const double one : phi_) reflected.push_back({std::acos(mu), one});
    std::vector<Mueller> matrices(reflected.size());
    for (std::size_t i = 0; i < grid.cosines; ++i) {
      evaluate(model.at(Direction{std::acos(mu_[i]), 0}), reflected, matrices, {.frame = Frame::sp, .threads = 0});
      for (std::size_t n = 0; n < matrices.size(); ++n) values_[n * grid.cosines + i] = value(matrices[n]);
    }
  }

  /// As the renderer does: linear, and after the last azimuth comes the first, which its loader repeats at 2π.
  double looked_up(const Geometry& geometry) const {
    const double turns = (geometry.reflected.phi - geometry.incident.phi) / (4 * half_pi);
    const auto [o, along_o] = place(std::cos(geometry.reflected.theta), grid_.cosines);
    const auto [p, along_p] = place(turns - std::floor(turns), grid_.azimuths + 1);
    const auto [i, along_i] = place(std::cos(geometry.incident.theta), grid_.cosines);
    double sum = 0;
    for (const std::size_t corner : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
      const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      sum += (a ? along_o : 1 - along_o) * (b ? along_p : 1 - along_p) * (c ? along_i : 1 - along_i) *
             values_[((o + a) * grid_.azimuths + (p + b) % grid_.azimuths) * grid_.cosines + i + c];
    }
    return sum;
  }

  std::string bytes(const Model& model, const std::string& channel, double wavelength) const {
    NewNetcdf file;
    const std::string range = fitted_range(model.validity);
    file.attribute("title", channel + (model.name.empty() ? "" : " of " + printable(model.name, 200)) + " at " +
                                nanometre_text({&wavelength, 1}) + ", for mqdiffuse of eradiate");
    file.attribute("source", "mmbrdf model, " + basis_line(model));
    file.attribute("fitted_range", range.empty() ? "not known" : range);
    file.axis("cos_theta_o", mu_,
              {{"units", "1"}, {"long_name", "cosine of the polar angle of the outgoing direction"}});
    file.axis("phi_d", phi_,
              {{"units", "rad"},
               {"long_name", "azimuth of the outgoing less that of the incoming direction; pi is forward"}});
    file.axis("cos_theta_i", mu_,
              {{"units", "1"}, {"long_name", "cosine of the polar angle of the direction to the source"}});
    file.variable("brdf", {"cos_theta_o", "phi_d", "cos_theta_i"}, values_, {{"units", "sr-1"}, {"long_name", "BRDF"}});
    return file.bytes();
  }

  long negative() const {
    return static_cast<long>(std::ranges::count_if(values_, [](double value) { return value < 0; }));
  }

 private:
  static std::pair<std::size_t, double> place(double part, std::size_t nodes) {
    const double x = std::clamp(part, 0.0, 1.0) * static_cast<double>(nodes - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(x), nodes - 2);
    return {below, x - static_cast<double>(below)};
  }

  CosineCounts grid_;
  std::vector<double> mu_, phi_, values_;
};

ExportError cosine_error(const CosineTable& table, const PreparedModel& model, const Channel& value, double theta_max) {
  Deviation deviation;
  for (const Geometry& geometry : random_geometries(4000, 1, theta_max)) {
    const Mueller m = model.evaluate(geometry, Frame::sp);
    deviation.add(table.looked_up(geometry), value(m), m(0, 0));
  }
  return deviation.error(theta_max);
}

}  // namespace

Export::Made make_mqdiffuse(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "an mqdiffuse");
  const PreparedModel prepared = prepare(model, one_wavelength(options, "an mqdiffuse file"));
  const Channel value = channel_of(model, options.channel);
  const double theta_max = compared_up_to(model);
  std::shared_ptr<const CosineTable> table;
  ExportError error;
  const CosineCounts* grid = cosine_grids.data();
  for (;; ++grid) {
    table = std::make_shared<const CosineTable>(prepared, *grid, value);
    error = cosine_error(*table, prepared, value, theta_max);
    if (error.rms <= options.error || grid == &cosine_grids.back()) break;
  }
  require_error(error, options, to_string(*grid));
  const auto bytes =
      std::make_shared<const std::string>(table->bytes(model, options.channel, options.wavelengths.front()));
  std::string understood = options.channel + " in sr^-1 at " + nanometre_text(options.wavelengths) + " over " +
                           to_string(*grid) + ", cosines from the horizon to the normal, pi is forward";
  if (table->negative() > 0) understood += "; " + std::to_string(table->negative()) + " values are negative";
  return {[bytes](std::ostream& out) { out.write(bytes->data(), static_cast<std::streamsize>(bytes->size())); }, error,
          understood};
}

}  // namespace mmbrdf
