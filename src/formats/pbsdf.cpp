// SPDX-License-Identifier: BSD-3-Clause
#include "formats/pbsdf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/half_difference.hpp"
#include "formats/tensor_file.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

class PbsdfReader : public ForeignFile::Reader {
 public:
  explicit PbsdfReader(const Source& source) : path_(source.path), file_(source) {
    source.require_none_told();
    const double half = std::numbers::pi / 2;
    phi_d_ = file_.angles("phi_d", -2 * std::numbers::pi, 2 * std::numbers::pi);
    theta_d_ = file_.angles("theta_d", 0, half);
    theta_h_ = file_.angles("theta_h", 0, half);
    wavelengths_ = file_.axis("wvls");
    for (double& wavelength : wavelengths_) {
      wavelength /= 1000;
      require_wavelength(wavelength, path_ + ": field wvls");
    }
    matrices_ = file_.field("M");
    file_.require_shape(matrices_, {phi_d_.size(), theta_d_.size(), theta_h_.size(), wavelengths_.size(), 4, 4});
    measured.set();
    understood = std::to_string(phi_d_.size()) + " phi_d, " + std::to_string(theta_d_.size()) + " theta_d, " +
                 std::to_string(theta_h_.size()) + " theta_h at " + nanometre_text(wavelengths_) +
                 ", f_ij in sr^-1 about the scattering plane, S4 > 0 right-handed, made into those of the frame xy and "
                 "S4 > 0 left-handed; phi_i = 0";
  }

  void read(const UseSamples& use) override {
    SampleSink sink(use);
    // Both ends of the circle are there, and are one.
    const bool closed = std::abs(phi_d_.back() - phi_d_.front() - 2 * std::numbers::pi) < single_precision;
    const std::size_t azimuths = phi_d_.size() - (closed && phi_d_.size() > 1 ? 1 : 0);
    std::vector<double> values(theta_h_.size() * wavelengths_.size() * 16);
    for (std::size_t p = 0; p < azimuths; ++p)
      for (std::size_t d = 0; d < theta_d_.size(); ++d) {
        file_.read(matrices_, (p * theta_d_.size() + d) * values.size(), values);
        for (std::size_t h = 0; h < theta_h_.size(); ++h)
          add(half_difference(theta_h_[h], theta_d_[d], phi_d_[p]),
              std::span(values).subspan(h * wavelengths_.size() * 16, wavelengths_.size() * 16), sink);
      }
    sink.finish(path_);
    passed_over = sink.passed_over("matrices");
  }

 private:
  void add(const HalfDifference& directions, std::span<const double> values, SampleSink& sink) const {
    if (!above_horizon(directions)) return sink.below_horizon(wavelengths_.size());
    const NodeAxes node(directions);
    for (std::size_t w = 0; w < wavelengths_.size(); ++w) {
      Mueller m;
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(16 * w), 16, m.elements.begin());
      // Zeros are what is written where nothing was measured.
      if (!std::ranges::all_of(m.elements, [](double e) { return std::isfinite(e); }) || m(0, 0) == 0) {
        sink.not_measured();
        continue;
      }
      const double f11 = m(0, 0);
      m = convert((1 / f11) * m, StokesConvention::s_first_right, StokesConvention::germer2017);
      m = node.left * m * node.right;
      m(0, 0) = 1;
      sink.add({.wavelength = wavelengths_[w], .geometry = node.geometry, .f11 = f11, .normalized = m});
    }
  }

  std::string path_;
  TensorFile file_;
  std::vector<double> phi_d_, theta_d_, theta_h_, wavelengths_;
  TensorField matrices_;
};

}  // namespace

bool is_pbsdf(std::string_view head, std::uint64_t) {
  return has_tensor(head, {"M", "theta_d", "theta_h", "phi_d", "wvls"});
}

std::unique_ptr<ForeignFile::Reader> open_pbsdf(const Source& source) { return std::make_unique<PbsdfReader>(source); }

}  // namespace mmbrdf
