// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <stdexcept>

#include "formats/export_table.hpp"
#include "formats/netcdf.hpp"
#include "formats/new_netcdf.hpp"
#include "formats/reader.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/moments.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/units.hpp"
#include "mmbrdf/uncertainty/prediction.hpp"
#include "numerics/threads.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::array netcdf_steps{10.0, 5.0, 2.5};  // degrees

/// Matrices in the frame sp at phi_i = 0 over theta_i, theta_r 0 … 90 and phi_r 0 … 360 degrees, both ends included.
class MatrixGrid {
 public:
  explicit MatrixGrid(double step)
      : thetas_(static_cast<std::size_t>(std::lround(90 / step)) + 1),
        azimuths_(static_cast<std::size_t>(std::lround(360 / step)) + 1) {
    for (const double theta_i : thetas())
      for (const double theta_r : thetas())
        for (const double phi_r : azimuths())
          geometries_.push_back({{radians(theta_i), 0}, {radians(theta_r), radians(phi_r)}});
  }

  std::vector<double> thetas() const { return rising(thetas_, 90); }
  std::vector<double> azimuths() const { return rising(azimuths_, 360); }
  const std::vector<Geometry>& geometries() const { return geometries_; }

  void add(const PreparedModel& model) {
    std::vector<Mueller> some(geometries_.size());
    evaluate(model, geometries_, some, {.frame = Frame::sp, .threads = 0});
    matrices_.insert(matrices_.end(), some.begin(), some.end());
  }
  const std::vector<Mueller>& matrices() const { return matrices_; }

  /// Linear along each axis, of the wavelength number w.
  Mueller looked_up(const Geometry& geometry, std::size_t w) const {
    const double turns = (geometry.reflected.phi - geometry.incident.phi) / (4 * half_pi);
    const auto [i, along_i] = place(geometry.incident.theta / half_pi, thetas_);
    const auto [r, along_r] = place(geometry.reflected.theta / half_pi, thetas_);
    const auto [p, along_p] = place(turns - std::floor(turns), azimuths_);
    Mueller sum{};
    for (const std::size_t corner : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
      const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      const double weight = (a ? along_i : 1 - along_i) * (b ? along_r : 1 - along_r) * (c ? along_p : 1 - along_p);
      const std::size_t node = ((i + a) * thetas_ + r + b) * azimuths_ + p + c;
      sum = sum + weight * matrices_[w * geometries_.size() + node];
    }
    return sum;
  }

 private:
  static std::vector<double> rising(std::size_t nodes, double last) {
    std::vector<double> result(nodes);
    for (std::size_t k = 0; k < nodes; ++k) result[k] = last * static_cast<double>(k) / static_cast<double>(nodes - 1);
    return result;
  }
  static std::pair<std::size_t, double> place(double part, std::size_t nodes) {
    const double x = part * static_cast<double>(nodes - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(x), nodes - 2);
    return {below, x - static_cast<double>(below)};
  }

  std::size_t thetas_, azimuths_;
  std::vector<Geometry> geometries_;
  std::vector<Mueller> matrices_;
};

ExportError grid_error(const MatrixGrid& grid, const std::vector<PreparedModel>& models, const Elements& unknown,
                       double theta_max) {
  Deviation deviation;
  const std::vector<Geometry> geometries = random_geometries(4000, 1, theta_max);
  for (std::size_t w = 0; w < models.size(); ++w)
    for (const Geometry& geometry : geometries) {
      const Mueller expected = models[w].evaluate(geometry, Frame::sp), found = grid.looked_up(geometry, w);
      for (std::size_t e = 0; e < 16; ++e)
        if (!unknown[e]) deviation.add(found.elements[e], expected.elements[e], expected(0, 0));
    }
  return deviation.error(theta_max);
}

std::span<const double> numbers_of(const std::vector<Mueller>& matrices) {
  static_assert(sizeof(Mueller) == 16 * sizeof(double));
  return {matrices.front().elements.data(), 16 * matrices.size()};
}

void add_axes(NewNetcdf& file, const MatrixGrid& grid, const std::vector<double>& wavelengths) {
  std::vector<double> nanometres;
  for (const double wavelength : wavelengths) nanometres.push_back(in_nanometres(wavelength));
  file.axis("wavelength_nm", nanometres, {{"units", "nm"}, {"standard_name", "radiation_wavelength"}});
  file.axis("theta_i_deg", grid.thetas(),
            {{"units", "degree"}, {"long_name", "polar angle of the direction to the source"}});
  file.axis("theta_r_deg", grid.thetas(),
            {{"units", "degree"}, {"long_name", "polar angle of the direction to the detector"}});
  file.axis("phi_r_deg", grid.azimuths(),
            {{"units", "degree"}, {"long_name", "azimuth of the direction to the detector; 180 is forward"}});
  const std::array numbers{1, 2, 3, 4};
  file.axis("row", numbers, {{"long_name", "component of the scattered Stokes vector"}});
  file.axis("column", numbers, {{"long_name", "component of the incident Stokes vector"}});
  const double zero = 0;
  file.variable("phi_i_deg", {}, {&zero, 1},
                {{"units", "degree"}, {"long_name", "azimuth of the direction to the source"}});
}

void add_flags(NewNetcdf& file, const MatrixGrid& grid, const std::vector<PreparedModel>& models) {
  std::vector<int> flags;
  for (const PreparedModel& model : models)
    for (const Geometry& geometry : grid.geometries()) flags.push_back(static_cast<int>(model.outside(geometry)));
  const std::array masks{static_cast<int>(outside_theta_i),    static_cast<int>(outside_theta_r),
                         static_cast<int>(outside_wavelength), static_cast<int>(unknown_range),
                         static_cast<int>(outside_directions), static_cast<int>(interpolated)};
  file.flags("validity", {"wavelength_nm", "theta_i_deg", "theta_r_deg", "phi_r_deg"}, flags, masks,
             {{"long_name", "0 inside the range of the fit; else extrapolated, in what"},
              {"flag_meanings", "theta_i theta_r wavelength unknown_range directions interpolated"}});
}

void add_words(NewNetcdf& file, const Model& model) {
  const std::string range = fitted_range(model.validity);
  file.attribute("Conventions", "CF-1.10");
  file.attribute("title", "Mueller-matrix BRDF " + printable(model.name, 200));
  file.attribute("source", "mmbrdf model, " + basis_line(model));
  file.attribute("fitted_range", range.empty() ? "not known" : range);
  std::string provenance;
  for (const auto& [key, value] : model.provenance)
    provenance += (provenance.empty() ? "" : "\n") + printable(key, 100) + ": " + printable(value, 2000);
  file.attribute("provenance", provenance.empty() ? "not known" : provenance);
}

/// Standard uncertainties at the nodes of the grid, row after row of azimuths. Where they are even in the azimuth, half of a
/// row is asked for: it takes a thousand times as long as a matrix.
void add_uncertainties(const PreparedUncertainty& prepared, const MatrixGrid& grid, bool even, std::span<Mueller> out) {
  const std::size_t row = grid.azimuths().size(), half = even ? row / 2 + 1 : row;
  in_any_order(out.size() / row, [&](std::size_t r) {
    const std::span<const Geometry> geometries = std::span(grid.geometries()).subspan(r * row, half);
    const std::span<Mueller> u = out.subspan(r * row, row);
    prepared.standard_uncertainty(geometries, Frame::sp, u.first(half));
    for (std::size_t a = half; a < row; ++a) u[a] = u[row - 1 - a];
  });
}

/// Of all wavelengths; none if the model does not know them.
std::vector<Mueller> grid_uncertainties(const Model& model, const MatrixGrid& grid,
                                        const std::vector<PreparedModel>& models, const ExportOptions& options) {
  if (!knows_uncertainty(model)) return {};
  const std::size_t nodes = grid.geometries().size();
  std::vector<Mueller> result(options.wavelengths.size() * nodes);
  for (std::size_t w = 0; w < options.wavelengths.size(); ++w)
    add_uncertainties(prepare_uncertainty(model, options.wavelengths[w]), grid, is_its_own_mirror_image(models[w]),
                      std::span(result).subspan(w * nodes, nodes));
  return result;
}

std::string netcdf_bytes(const Model& model, const MatrixGrid& grid, const std::vector<PreparedModel>& models,
                         const std::vector<Mueller>& u, const ExportOptions& options) {
  NewNetcdf file;
  add_words(file, model);
  add_axes(file, grid, options.wavelengths);
  const NewNetcdf::Axes axes{"wavelength_nm", "theta_i_deg", "theta_r_deg", "phi_r_deg", "row", "column"};
  const std::string axes_of_light =
      "Stokes axes (s, p) of each beam, s = z x k, p = k x s; S2 = s - p, S3 = +45 - -45 degrees from s to p, S4 = "
      "left "
      "- right";
  file.variable("brdf", axes, numbers_of(grid.matrices()),
                {{"units", "sr-1"},
                 {"long_name", "Mueller BRDF: scattered radiance per incident irradiance, Stokes vectors"},
                 {"frame", "sp"},
                 {"convention", "germer2017: " + axes_of_light},
                 {"coordinates", "phi_i_deg"},
                 {"ancillary_variables", u.empty() ? "validity" : "uncertainty validity"}});
  if (!u.empty())
    file.variable(
        "uncertainty", axes, numbers_of(u),
        {{"units", "sr-1"}, {"long_name", "standard uncertainty (k = 1) of brdf"}, {"coordinates", "phi_i_deg"}});
  add_flags(file, grid, models);
  return file.bytes();
}

/// Throws std::invalid_argument for so many numbers that they and their uncertainties may not fit into memory.
void require_moderate(const MatrixGrid& grid, std::size_t wavelengths, double step) {
  constexpr std::size_t most = 100'000'000;
  const std::size_t numbers = 16 * grid.geometries().size() * wavelengths;
  if (numbers > most)
    throw std::invalid_argument("steps of " + shortest(step) + " degrees at " + std::to_string(wavelengths) +
                                " wavelengths are " + std::to_string(numbers / 1'000'000) +
                                " million numbers, more than 100 million: ask for fewer wavelengths or a larger error");
}

}  // namespace

Export::Made make_netcdf(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "a NetCDF");
  const Elements unknown = unknown_elements(model, Frame::sp);
  std::vector<PreparedModel> models;
  for (const double wavelength : options.wavelengths) models.push_back(prepare(model, wavelength));
  const double theta_max = compared_up_to(model);
  std::unique_ptr<MatrixGrid> grid;
  ExportError error;
  double step = 0;
  for (const double degrees : netcdf_steps) {
    step = degrees;
    grid = std::make_unique<MatrixGrid>(step);
    require_moderate(*grid, models.size(), step);
    for (const PreparedModel& prepared : models) grid->add(prepared);
    error = grid_error(*grid, models, unknown, theta_max);
    if (error.rms <= options.error) break;
  }
  require_error(error, options, "steps of " + shortest(step) + " degrees");
  const std::vector<Mueller> u = grid_uncertainties(model, *grid, models, options);
  const auto bytes = std::make_shared<const std::string>(netcdf_bytes(model, *grid, models, u, options));
  std::string understood =
      "f_ij in sr^-1 at " + nanometre_text(options.wavelengths) +
      ", polar angles of 0 to 90 and azimuths of 0 to 360 degrees in steps of " + shortest(step) +
      ", phi_i = 0, frame sp, convention germer2017" +
      (u.empty() ? ", with flags of what is extrapolated, without uncertainties, which the model does not know"
                 : ", with standard uncertainties and flags of what is extrapolated");
  if (const auto negative = std::ranges::count_if(grid->matrices(), [](const Mueller& m) { return m(0, 0) < 0; });
      negative > 0)
    understood += "; f11 is negative at " + std::to_string(negative) + " of " +
                  std::to_string(grid->matrices().size()) + " nodes";
  if (unknown.any()) understood += "; " + not_measured_line(model.not_measured);
  return {[bytes](std::ostream& out) { out.write(bytes->data(), static_cast<std::streamsize>(bytes->size())); }, error,
          understood};
}

}  // namespace mmbrdf
