// SPDX-License-Identifier: BSD-3-Clause
// What the BRDF supplement of VLIDORT fills, as text that list-directed reads take. Part of transfer.hpp.

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "formats/export_table.hpp"
#include "formats/reader.hpp"
#include "formats/transfer.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/model/moments.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

/// Q > 0 along the meridian plane, U as S3 here, V > 0 right-handed: what VLIDORT's own kernel of a wavy sea (GCMCRI) gives for
/// facets that reflect by Fresnel's equations.
Mueller as_vlidort(const Mueller& m_sp) {
  return pi * convert(m_sp, StokesConvention::germer2017, StokesConvention::p_first_left_handed_axes_right);
}

/// Of azimuths that count from forward. What couples linear polarization along the axes with that between them is odd in
/// the azimuth, and such a moment enters the sum of incident light with minus.
Mueller stored_moment(const FourierMoments& moments, std::size_t m) {
  Mueller f{};
  if (m >= moments.cosine.size()) return f;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const double sine = moments.sine[m](row, column);
      f(row, column) = (row < 2) == (column < 2) ? moments.cosine[m](row, column) : row < 2 ? -sine : sine;
    }
  return as_vlidort(m % 2 == 0 ? f : -1.0 * f);
}

/// How many Stokes components all elements are known of.
int components_known(const Elements& unknown) {
  for (const int n : {4, 3}) {
    bool known = true;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) known = known && !unknown[Element{row, column}.index()];
    if (known) return n;
  }
  return 1;
}

/// VLIDORT counts azimuths from forward and takes 0 ... 360 degrees. Without the digits that a difference such as
/// 370.1 - 360 ends in.
double degrees_from_forward(double azimuth) {
  const double turned = std::fmod(in_degrees(azimuth) + 180, 360);  // -180 ... 540 are in 0 ... 360
  const double positive = std::round((turned < 0 ? turned + 360 : turned) * 1e10) / 1e10;
  return positive < 360 ? positive : 0;
}

class VlidortTable {
 public:
  VlidortTable(const PreparedModel& model, const TransferAngles& angles, int components)
      : model_(model), angles_(angles), components_(components), streams_(stream_cosines(angles.streams)) {
    for (const Node& stream : streams_) of_streams_.push_back(stream.x);
    for (const double sun : angles.suns) of_suns_.push_back(std::cos(sun));
    for (const double view : angles.views) of_views_.push_back(std::cos(view));
  }

  void write(std::ostream& out, const std::vector<std::string>& words) const {
    out << words.size() << ' ' << components_ << ' ' << streams_.size() << ' ' << angles_.moments << ' '
        << angles_.suns.size() << ' ' << angles_.views.size() << ' ' << angles_.azimuths.size() << '\n';
    for (const std::string& line : words) out << line << '\n';
    for (const Node& stream : streams_) out << shortest(stream.x) << ' ' << shortest(stream.weight) << '\n';
    for (const std::vector<double>* one : {&angles_.suns, &angles_.views})
      for (const double angle : *one) out << shortest(in_degrees(angle)) << '\n';
    for (const double azimuth : angles_.azimuths) out << shortest(degrees_from_forward(azimuth)) << '\n';
    write_moments(out, of_streams_, of_suns_);
    write_moments(out, of_streams_, of_streams_);
    write_exact(out);
    write_moments(out, of_views_, of_suns_);
    write_moments(out, of_views_, of_streams_);
  }

  /// The most that moments which are not there add up to in an element, as a part of the mean of f11.
  double left_out() const {
    double largest = 0;
    for (const FourierMoments& moments : fourier_moments(model_, of_streams_, of_streams_))
      for (std::size_t e = 0; e < 16; ++e) {
        double sum = 0;
        for (auto m = static_cast<std::size_t>(angles_.moments); m < moments.cosine.size(); ++m)
          sum += std::abs(moments.cosine[m].elements[e]) + std::abs(moments.sine[m].elements[e]);
        if (std::isfinite(sum)) largest = std::max(largest, sum / std::abs(moments.cosine[0](0, 0)));
      }
    return largest;
  }

 private:
  double known(const Mueller& m, int row, int column) const {
    return row < components_ && column < components_ ? m(row, column) + 0.0 : 0;  // no -0
  }

  void write_moments(std::ostream& out, const std::vector<double>& reflected,
                     const std::vector<double>& incident) const {
    const std::vector<FourierMoments> all = fourier_moments(model_, incident, reflected);
    for (std::size_t i = 0; i < incident.size(); ++i)
      for (std::size_t r = 0; r < reflected.size(); ++r) {
        std::vector<Mueller> stored;
        for (int m = 0; m < angles_.moments; ++m)
          stored.push_back(stored_moment(all[r * incident.size() + i], static_cast<std::size_t>(m)));
        for (int row = 0; row < 4; ++row)
          for (int column = 0; column < 4; ++column) {
            std::string line;
            for (const Mueller& m : stored) line += (line.empty() ? "" : " ") + rounded(known(m, row, column), 10);
            out << line << '\n';
          }
      }
  }

  void write_exact(std::ostream& out) const {
    for (const double sun : angles_.suns)
      for (const double azimuth : angles_.azimuths)
        for (const double view : angles_.views) {
          const Mueller m = as_vlidort(model_.evaluate({{sun, 0}, {view, azimuth}}, Frame::sp));
          std::string line;
          for (int row = 0; row < 4; ++row)
            for (int column = 0; column < 4; ++column)
              line += (line.empty() ? "" : " ") + rounded(known(m, row, column), 10);
          out << line << '\n';
        }
  }

  PreparedModel model_;
  TransferAngles angles_;
  int components_;
  std::vector<Node> streams_;
  std::vector<double> of_streams_, of_suns_, of_views_;
};

std::vector<std::string> words_of(const Model& model, double wavelength) {
  return {"mmbrdf: surface for VLIDORT, model " + shown_name(model.name) + " at " + nanometre_text({&wavelength, 1}),
          "line 1: lines of text, nstokes, nstreams, moments m = 0 ..., suns, views, azimuths",
          "values: pi x BRDF; Stokes (I, Q, U, V) about the meridian planes, Q > 0 along them, V > 0 right-handed",
          "f(phi) = sum over m of F_m cos(m phi), weight 1 for every m; phi = 0 is forward",
          "13 14 23 24: f = -sum F_m sin(m phi); 31 32 41 42: f = +sum F_m sin(m phi)",
          "then nstreams cosines with their weights (Gauss-Legendre on 0 to 1, of integrals over mu),",
          "suns and views in degrees from the normal, azimuths in degrees,",
          "BRDF_F_0(m, q, stream, sun), BRDF_F(m, q, reflected, incident), DBOUNCE(q, view, azimuth, sun),",
          "USER_BRDF_F_0(m, q, view, sun), USER_BRDF_F(m, q, view, incident): the first index rises fastest,",
          "q = 4 (row - 1) + column = 1 ... 16, row of the reflected light"};
}

void require_complete(const TransferAngles& angles) {
  constexpr int most = 100;  // a file of 400 MB
  if (angles.streams < 1 || angles.streams > most)
    throw std::invalid_argument("a VLIDORT file needs its number of streams, cosines in a hemisphere: 1 to " +
                                std::to_string(most));
  if (angles.suns.empty()) throw std::invalid_argument("a VLIDORT file needs suns, their polar angles");
  if (angles.views.empty() != angles.azimuths.empty())
    throw std::invalid_argument("views and azimuths of a VLIDORT file come together");
  require_polar_angles(angles.suns, "a sun");
  require_polar_angles(angles.views, "a view");
  require_azimuths(angles.azimuths);
}

}  // namespace

Export::Made make_vlidort(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "a VLIDORT");
  TransferAngles angles = options.transfer;
  require_complete(angles);
  angles.moments = moments_carried(angles.moments, angles.streams);
  const PreparedModel prepared = prepare(model, one_wavelength(options, "a VLIDORT file"));
  if (!is_its_own_mirror_image(prepared))
    throw std::invalid_argument(
        "a VLIDORT file is of a sample that is its own mirror image: elements of this model have sines of phi_r - "
        "phi_i "
        "beside cosines, or in place of them, and there is room for one of the two");
  const Elements unknown = unknown_elements(model, Frame::sp);
  const int components = components_known(unknown);
  const auto table = std::make_shared<const VlidortTable>(prepared, angles, components);
  std::string understood = "pi f at " + nanometre_text(options.wavelengths) + ", " + std::to_string(components) +
                           (components == 1 ? " Stokes component" : " Stokes components") + ", " +
                           counted(angles.moments, "moment") + " at " + counted(angles.streams, "stream") + ", " +
                           counted(static_cast<long>(angles.suns.size()), "sun") + ", " +
                           counted(static_cast<long>(angles.views.size()), "view") + " at " +
                           counted(static_cast<long>(angles.azimuths.size()), "azimuth") +
                           "; Q > 0 along the meridian plane, azimuth 0 is forward";
  if (unknown.any()) understood += "; " + not_measured_line(unknown);
  if (const int last = highest_moment(prepared); last >= angles.moments)
    understood += "; the model has moments up to m = " + std::to_string(last) + ": those left out add up to at most " +
                  rounded(100 * table->left_out(), 2) + " % of f11 at the streams";
  else
    understood += "; the model has none beyond m = " + std::to_string(last);
  return {
      [table, words = words_of(model, options.wavelengths.front())](std::ostream& out) { table->write(out, words); },
      {},
      understood};
}

}  // namespace mmbrdf
