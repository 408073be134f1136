// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <vector>

#include "formats/export_table.hpp"
#include "formats/rgl.hpp"
#include "formats/tensor_file.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// Steps of theta_i in degrees, and nodes along each side of the square of half directions.
struct RglGrid {
  double step;
  std::size_t side;
};
constexpr std::array rgl_grids{RglGrid{10, 33}, RglGrid{5, 65}, RglGrid{2.5, 129}, RglGrid{1.25, 257}};

/// Of the half direction at a place (u, v) of the square: theta = u² π/2, phi = (2v − 1) π from that of the source.
Vector3 half_direction(double u, double v) { return unit_vector({u * u * half_pi, (2 * v - 1) * 2 * half_pi}); }

double along(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// With a constant density of half directions, samples of it are the half directions themselves, and spectra are
/// f cos theta_r times 4 sigma / ndf, whatever these constants are: those of a sphere's normals.
constexpr float normals = static_cast<float>(1 / (2 * half_pi)), projected = 1;
constexpr double spectra_of_f_cos = 4.0 * static_cast<double>(projected) / static_cast<double>(normals);

class RglTable {
 public:
  RglTable(const std::vector<PreparedModel>& models, const Channel& channel, const RglGrid& grid)
      : side_(grid.side), wavelengths_(models.size()) {
    for (double theta = 0; theta <= 90; theta += grid.step)
      theta_i_.push_back(std::min(static_cast<float>(radians(theta)), largest_single));
    spectra_.resize(theta_i_.size() * wavelengths_ * side_ * side_);
    luminance_.resize(theta_i_.size() * side_ * side_);
    for (std::size_t t = 0; t < theta_i_.size(); ++t) fill(t, models, channel);
  }

  /// f as readers find it: linear over theta_i and in the square.
  double looked_up(const Geometry& geometry, std::size_t w) const {
    const double theta_i = geometry.incident.theta, phi = geometry.reflected.phi - geometry.incident.phi;
    const Vector3 i = unit_vector({theta_i, 0}), o = unit_vector({geometry.reflected.theta, phi});
    const Vector3 h{i[0] + o[0], i[1] + o[1], i[2] + o[2]};
    const double u = std::sqrt(std::atan2(std::hypot(h[0], h[1]), h[2]) / half_pi),
                 v = std::atan2(h[1], h[0]) / (4 * half_pi) + 0.5;
    std::size_t t = 0;
    while (t + 2 < theta_i_.size() && static_cast<double>(theta_i_[t + 1]) <= theta_i) ++t;
    const double first = static_cast<double>(theta_i_[t]), part = (theta_i - first) / (theta_i_[t + 1] - first);
    const double spectrum = (1 - part) * in_square(t, w, u, v) + part * in_square(t + 1, w, u, v);
    return spectrum / spectra_of_f_cos / o[2];
  }

  void write(std::ostream& out, const std::string& description, const std::vector<float>& nanometres) const {
    const std::vector<float> phi_i{0}, of_normals(4, normals), of_area(4, projected), flat(4 * theta_i_.size(), 1);
    const std::uint64_t thetas = theta_i_.size(), side = side_;
    write_tensor_file(
        out,
        std::array{NewTensor{.name = "description", .shape = {description.size()}, .bytes = description},
                   NewTensor{.name = "theta_i", .shape = {thetas}, .singles = theta_i_},
                   NewTensor{.name = "phi_i", .shape = {1}, .singles = phi_i},
                   NewTensor{.name = "ndf", .shape = {2, 2}, .singles = of_normals},
                   NewTensor{.name = "sigma", .shape = {2, 2}, .singles = of_area},
                   NewTensor{.name = "vndf", .shape = {1, thetas, 2, 2}, .singles = flat},
                   NewTensor{.name = "luminance", .shape = {1, thetas, side, side}, .singles = luminance_},
                   NewTensor{.name = "wavelengths", .shape = {nanometres.size()}, .singles = nanometres},
                   NewTensor{.name = "spectra", .shape = {1, thetas, wavelengths_, side, side}, .singles = spectra_},
                   NewTensor{.name = "jacobian", .shape = {1}, .bytes = "\1"}});
  }

  /// "; 3 of 20 values are negative", of those above the horizon; or nothing.
  std::string negative_text() const {
    if (negative_ == 0) return "";
    return "; " + std::to_string(negative_) + " of " + std::to_string(above_) +
           " values above the horizon are negative";
  }

  std::string grid_text() const {
    return std::to_string(theta_i_.size()) + " theta_i, " + std::to_string(side_) + " x " + std::to_string(side_) +
           " half directions";
  }

 private:
  static constexpr float largest_single = 1.5707963F;  // below π/2

  void fill(std::size_t t, const std::vector<PreparedModel>& models, const Channel& channel) {
    const Direction incident{static_cast<double>(theta_i_[t]), 0};
    const Vector3 i = unit_vector(incident);
    const std::size_t cells = side_ * side_;
    std::vector<Direction> reflected;
    std::vector<double> cosine, density;  // solid angle of the reflected direction for a part of the square, unscaled
    for (std::size_t y = 0; y < side_; ++y)
      for (std::size_t x = 0; x < side_; ++x) {
        const double u = static_cast<double>(x) / static_cast<double>(side_ - 1);
        const Vector3 m = half_direction(u, static_cast<double>(y) / static_cast<double>(side_ - 1));
        const double facing = along(m, i);
        const Vector3 o{2 * facing * m[0] - i[0], 2 * facing * m[1] - i[1], 2 * facing * m[2] - i[2]};
        reflected.push_back(direction(raised(o)));
        cosine.push_back(o[2]);
        density.push_back(o[2] > 0 && facing > 0 ? u * std::hypot(m[0], m[1]) * facing : 0);
      }
    float* const bright = &luminance_[t * cells];
    std::vector<Mueller> matrices(cells);
    for (std::size_t w = 0; w < wavelengths_; ++w) {
      models[w].at(incident).evaluate(reflected, Frame::sp, matrices);
      for (std::size_t n = 0; n < cells; ++n) {
        // Beyond the horizon f cos goes on with the cosine, so that it is linear in the cells across it.
        const double f_cos = channel(matrices[n]) * cosine[n];
        if (cosine[n] > 0) ++above_, negative_ += f_cos < 0 ? 1 : 0;
        spectra_[(t * wavelengths_ + w) * cells + n] = static_cast<float>(spectra_of_f_cos * f_cos);
        bright[n] += static_cast<float>(std::max(0.0, f_cos) * density[n]);
      }
    }
    if (std::all_of(bright, bright + cells, [](float value) { return value == 0; })) std::fill_n(bright, cells, 1.0F);
  }

  double in_square(std::size_t t, std::size_t w, double u, double v) const {
    const double last = static_cast<double>(side_ - 1);
    const double x = std::clamp(u, 0.0, 1.0) * last, y = std::clamp(v, 0.0, 1.0) * last;
    const std::size_t column = std::min(static_cast<std::size_t>(x), side_ - 2),
                      row = std::min(static_cast<std::size_t>(y), side_ - 2);
    const float* const at = &spectra_[((t * wavelengths_ + w) * side_ + row) * side_ + column];
    const double a = x - static_cast<double>(column), b = y - static_cast<double>(row);
    const auto value = [&](std::size_t n) { return static_cast<double>(at[n]); };
    return (1 - b) * ((1 - a) * value(0) + a * value(1)) + b * ((1 - a) * value(side_) + a * value(side_ + 1));
  }

  std::size_t side_, wavelengths_, above_ = 0, negative_ = 0;
  std::vector<float> theta_i_, spectra_, luminance_;
};

ExportError error_of(const RglTable& table, const std::vector<PreparedModel>& models, const Channel& channel,
                     double theta_max) {
  Deviation deviation;
  for (const Geometry& geometry : random_geometries(4000, 1, theta_max))
    for (std::size_t w = 0; w < models.size(); ++w) {
      const Mueller m = models[w].evaluate(geometry, Frame::sp);
      deviation.add(table.looked_up(geometry, w), channel(m), m(0, 0));
    }
  return deviation.error(theta_max);
}

}  // namespace

Export::Made make_rgl(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "an RGL");
  const Channel channel = channel_of(model, options.channel);
  std::vector<PreparedModel> models;
  std::vector<float> nanometres;
  for (const double wavelength : options.wavelengths) {
    models.push_back(prepare(model, wavelength));
    nanometres.push_back(static_cast<float>(in_nanometres(wavelength)));
  }
  const double theta_max = compared_up_to(model);
  std::shared_ptr<const RglTable> table;
  ExportError error;
  for (const RglGrid& grid : rgl_grids) {
    table = std::make_shared<const RglTable>(models, channel, grid);
    error = error_of(*table, models, channel, theta_max);
    if (error.rms <= options.error) break;
  }
  require_error(error, options, table->grid_text());
  const std::string description = printable(model.name.empty() ? "mmbrdf" : model.name, 200) + ": " + options.channel;
  const auto write = [table, description, nanometres](std::ostream& out) {
    table->write(out, description, nanometres);
  };
  return {write, error,
          table->grid_text() + ", f cos(theta_r) of " + options.channel + " at " + nanometre_text(options.wavelengths) +
              ", isotropic; densities of normals are constants" + table->negative_text()};
}

}  // namespace mmbrdf
