// SPDX-License-Identifier: BSD-3-Clause
#include "formats/rgl.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/half_difference.hpp"
#include "formats/tensor_file.hpp"
#include "formats/warp.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

/// Polar angle and azimuth of a place in the unit square.
double theta_at(double u) { return u * u * pi / 2; }
double phi_at(double u) { return (2 * u - 1) * pi; }

/// A grid of positive numbers.
struct Grid {
  std::vector<double> values;
  std::size_t nx = 0;
};

class RglReader : public ForeignFile::Reader {
 public:
  explicit RglReader(const Source& source) : path_(source.path), file_(source) {
    theta_i_ = file_.angles("theta_i", 0, pi / 2);
    phi_i_ = file_.angles("phi_i", -2 * pi, 2 * pi);
    ndf_ = grid("ndf");
    sigma_ = grid("sigma");
    vndf_ = file_.field("vndf");
    require_grid(vndf_, 2);
    find_spectra(source);
    if (const TensorField& field = file_.field("jacobian"); field.shape != std::vector<std::uint64_t>{1})
      throw file_.error(field, "must have the shape [1]");
    with_density_ = numbers("jacobian")[0] != 0;
    understood = std::to_string(theta_i_.size()) + " theta_i, " + std::to_string(phi_i_.size()) + " phi_i, " +
                 std::to_string(nx_) + " x " + std::to_string(ny_) + " samples of normals made into directions, " +
                 spectra_.name + (with_density_ ? " * ndf / (4 sigma cos(theta_r))" : " / cos(theta_r)") +
                 " = f11 in sr^-1 at " + nanometre_text(wavelengths_) + (told_ ? " as told" : "") +
                 (isotropic() ? "; phi_i = 0" : "");
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    const std::uint64_t cells = nx_ * ny_, normals = vndf_.shape[2] * vndf_.shape[3];
    std::vector<double> density(normals), spectra(wavelengths_.size() * cells);
    for (std::size_t p = 0; p < phi_i_.size(); ++p)
      for (std::size_t t = 0; t < theta_i_.size(); ++t) {
        const std::uint64_t slice = p * theta_i_.size() + t;
        file_.read(vndf_, slice * normals, density);
        require_density(density, vndf_);
        file_.read(spectra_, slice * spectra.size(), spectra);
        const Warp warp(density, static_cast<std::size_t>(vndf_.shape[3]));
        if (!warp.valid())
          sink.not_measured(spectra.size());
        else
          add_slice(theta_i_[t], phi_i_[p], warp, spectra, sink);
      }
    sink.finish(path_);
    passed_over = sink.passed_over("values");
  }

 private:
  bool isotropic() const { return phi_i_.size() <= 2; }

  std::vector<double> numbers(const std::string& name) {
    const TensorField& field = file_.field(name);
    std::uint64_t count = 1;
    for (const std::uint64_t size : field.shape) count *= size;
    std::vector<double> values(count);
    file_.read(field, 0, values);
    return values;
  }

  /// The last two axes are those of a grid; `before` others are phi_i and theta_i.
  void require_grid(const TensorField& field, std::size_t before) const {
    std::vector<std::uint64_t> shape = field.shape;
    if (shape.size() != before + 2 || shape[before] < 2 || shape[before + 1] < 2)
      throw file_.error(field, "must have " + std::to_string(before + 2) + " axes, the last two of 2 nodes or more");
    if (before == 2) shape[0] = phi_i_.size(), shape[1] = theta_i_.size();
    file_.require_shape(field, shape);
  }

  void require_density(const std::vector<double>& values, const TensorField& field) const {
    for (const double value : values)
      if (!(value >= 0) || std::isinf(value)) throw file_.error(field, shortest(value) + " is no density");
  }

  Grid grid(const std::string& name) {
    const TensorField& field = file_.field(name);
    require_grid(field, 0);
    Grid result{numbers(name), static_cast<std::size_t>(field.shape[1])};
    require_density(result.values, field);
    return result;
  }

  void find_spectra(const Source& source) {
    const std::vector<std::string> names = tensor_names(source.head);
    if (std::ranges::find(names, "spectra") != names.end()) {
      source.require_none_told();
      spectra_ = file_.field("spectra");
      wavelengths_ = file_.axis("wavelengths");
      for (double& wavelength : wavelengths_) {
        wavelength /= 1000;
        require_wavelength(wavelength, path_ + ": field wavelengths");
      }
    } else {
      spectra_ = file_.field("rgb");
      wavelengths_ = source.told_wavelengths(3, "3 colours, red, green and blue");
      told_ = true;
    }
    if (spectra_.shape.size() != 5 || spectra_.shape[3] < 2 || spectra_.shape[4] < 2)
      throw file_.error(spectra_, "must have 5 axes, the last two of 2 nodes or more");
    ny_ = static_cast<std::size_t>(spectra_.shape[3]);
    nx_ = static_cast<std::size_t>(spectra_.shape[4]);
    file_.require_shape(spectra_, {phi_i_.size(), theta_i_.size(), wavelengths_.size(), ny_, nx_});
  }

  void add_slice(double theta_i, double phi_i, const Warp& warp, const std::vector<double>& spectra,
                 SampleSink& sink) const {
    const Vector3 i = unit_vector({theta_i, phi_i});
    const double sigma =
        bilinear(sigma_.values, sigma_.nx, std::sqrt(theta_i * 2 / pi), std::clamp((phi_i + pi) / (2 * pi), 0.0, 1.0));
    for (std::size_t y = 0; y < ny_; ++y)
      for (std::size_t x = 0; x < nx_; ++x) {
        const auto [u, v] = warp(static_cast<double>(x) / static_cast<double>(nx_ - 1),
                                 static_cast<double>(y) / static_cast<double>(ny_ - 1));
        const Vector3 m = unit_vector({theta_at(u), phi_at(v) + (isotropic() ? phi_i : 0)});
        const double along = 2 * (m[0] * i[0] + m[1] * i[1] + m[2] * i[2]);
        const Vector3 o{along * m[0] - i[0], along * m[1] - i[1], along * m[2] - i[2]};
        if (o[2] <= horizon || i[2] <= horizon) {
          sink.below_horizon(wavelengths_.size());
          continue;
        }
        const Geometry geometry = isotropic() ? isotropic_geometry(i, o) : Geometry{{theta_i, phi_i}, direction(o)};
        const double factor = (with_density_ ? bilinear(ndf_.values, ndf_.nx, u, v) / (4 * sigma) : 1) / o[2];
        for (std::size_t w = 0; w < wavelengths_.size(); ++w)
          add(factor * spectra[(w * ny_ + y) * nx_ + x], wavelengths_[w], geometry, sink);
      }
  }

  static void add(double f11, double wavelength, const Geometry& geometry, SampleSink& sink) {
    if (std::isfinite(f11))
      sink.add(scalar_sample(wavelength, geometry, f11));
    else
      sink.not_measured();
  }

  std::string path_;
  TensorFile file_;
  std::vector<double> theta_i_, phi_i_, wavelengths_;
  Grid ndf_, sigma_;
  TensorField vndf_, spectra_;
  std::size_t nx_ = 0, ny_ = 0;
  bool told_ = false, with_density_ = true;
};

}  // namespace

bool is_rgl(std::string_view head, std::uint64_t) {
  return has_tensor(head, {"vndf", "ndf", "sigma", "spectra", "rgb"});
}

std::unique_ptr<ForeignFile::Reader> open_rgl(const Source& source) { return std::make_unique<RglReader>(source); }

}  // namespace mmbrdf
