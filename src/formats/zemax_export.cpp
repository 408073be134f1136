// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <vector>

#include "formats/export_table.hpp"
#include "formats/zemax.hpp"
#include "mmbrdf/model/moments.hpp"
#include "mmbrdf/radiometry/reflectance.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

constexpr std::array specular_steps{5.0, 2.5, 1.25};  // degrees

/// Values at angles of incidence of 0 to 90 degrees, azimuths of 0 to 180 degrees if the other half is the mirror image, or
/// else 360, and radial angles of 0 to 180 degrees about the specular ray, in equal steps.
class SpecularTable {
 public:
  SpecularTable(const PreparedModel& model, const Channel& channel, double step, bool symmetrical)
      : degrees_(step),
        step_(radians(step)),
        incidences_(nodes(90, step)),
        azimuths_(nodes(symmetrical ? 180 : 360, step)),
        radials_(nodes(180, step)),
        symmetrical_(symmetrical) {
    for (std::size_t i = 0; i < incidences_; ++i)
      for (std::size_t a = 0; a < azimuths_; ++a)
        for (std::size_t r = 0; r < radials_; ++r) {
          const double theta_i = std::min(angle(i), half_pi);
          const Vector3 o = raised(about_specular(theta_i, angle(a), angle(r)));
          values_.push_back(channel(model.evaluate({{theta_i, 0}, direction(o)}, Frame::sp)));
        }
  }

  /// As readers do: linear along each angle.
  double looked_up(const Geometry& geometry) const {
    const double theta_i = geometry.incident.theta;
    const Vector3 o = unit_vector({geometry.reflected.theta, geometry.reflected.phi - geometry.incident.phi});
    const double x = o[0] * std::cos(theta_i) + o[2] * std::sin(theta_i),
                 z = o[2] * std::cos(theta_i) - o[0] * std::sin(theta_i);
    const double turn = std::atan2(o[1], x);
    const auto [i, along_i] = place(theta_i, incidences_);
    const auto [a, along_a] = place(symmetrical_ ? std::abs(turn) : turn + (turn < 0 ? 4 * half_pi : 0), azimuths_);
    const auto [r, along_r] = place(std::atan2(std::hypot(x, o[1]), z), radials_);
    double sum = 0;
    for (const std::size_t corner : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
      const std::size_t di = corner & 1, da = corner >> 1 & 1, dr = corner >> 2;
      sum += (di ? along_i : 1 - along_i) * (da ? along_a : 1 - along_a) * (dr ? along_r : 1 - along_r) *
             values_[((i + di) * azimuths_ + a + da) * radials_ + r + dr];
    }
    return sum;
  }

  void write(std::ostream& out, const std::vector<double>& tis) const {
    out << "AngleOfIncidence  " << incidences_ << '\n' << angles(incidences_);
    out << "ScatterAzimuth  " << azimuths_ << '\n' << angles(azimuths_);
    out << "ScatterRadial  " << radials_ << '\n' << angles(radials_) << "\nMonochrome\nDataBegin\n";
    const double* at = values_.data();
    for (std::size_t i = 0; i < incidences_; ++i) {
      out << "TIS " << rounded(tis[i], 8) << '\n';
      for (std::size_t a = 0; a < azimuths_; ++a) {
        std::string line;
        for (std::size_t r = 0; r < radials_; ++r) line += (r > 0 ? "\t" : "") + rounded(*at++, 8);
        out << line << '\n';
      }
    }
    out << "DataEnd\n";
  }

  bool symmetrical() const { return symmetrical_; }
  std::size_t incidences() const { return incidences_; }
  double theta_i(std::size_t i) const { return std::min(angle(i), half_pi); }
  const std::vector<double>& values() const { return values_; }

 private:
  static std::size_t nodes(double whole, double step) {
    return static_cast<std::size_t>(std::lround(whole / step)) + 1;
  }
  double angle(std::size_t k) const { return radians(degrees_ * static_cast<double>(k)); }

  std::string angles(std::size_t count) const {
    std::string line;
    for (std::size_t k = 0; k < count; ++k) line += (k > 0 ? "\t" : "") + shortest(degrees_ * static_cast<double>(k));
    return line + '\n';
  }

  std::pair<std::size_t, double> place(double value, std::size_t count) const {
    const double x = std::clamp(value / step_, 0.0, static_cast<double>(count - 1));
    const std::size_t below = std::min(static_cast<std::size_t>(x), count - 2);
    return {below, x - static_cast<double>(below)};
  }

  double degrees_, step_;
  std::size_t incidences_, azimuths_, radials_;
  bool symmetrical_;
  std::vector<double> values_;
};

/// What is scattered into the hemisphere of light from theta_i.
double total_scatter(const PreparedModel& model, const Channel& channel, double theta_i, int nodes) {
  double sum = 0;
  for (const WeightedDirection& node : Aperture::hemisphere().quadrature(nodes))
    sum += node.weight * channel(model.evaluate({{theta_i, 0}, node.direction}, Frame::sp));
  return sum;
}

const char* symmetry_of(const SpecularTable& table) {
  return table.symmetrical() ? "PlaneSymmetrical" : "Asymmetrical";
}

std::string zemax_head(const SpecularTable& table, const Model& model, const ExportOptions& options) {
  return "# " + options.channel + " in sr^-1" + (model.name.empty() ? "" : " of " + printable(model.name, 60)) +
         "\n# Wavelength (nm) = " + shortest(in_nanometres(options.wavelengths.front())) +
         "\nSource  Measured\nSymmetry  " + symmetry_of(table) +
         "\nSpectralContent  Monochrome\nScatterType  BRDF\nSampleRotation  1\n0\n";
}

ExportError error_of(const SpecularTable& table, const PreparedModel& model, const Channel& channel,
                     const std::vector<Geometry>& compared, double theta_max) {
  Deviation deviation;
  for (const Geometry& geometry : compared) {
    const Mueller m = model.evaluate(geometry, Frame::sp);
    deviation.add(table.looked_up(geometry), channel(m), m(0, 0));
  }
  return deviation.error(theta_max);
}

std::string zemax_understood(const SpecularTable& table, const ExportOptions& options, double step) {
  std::string text = std::string(symmetry_of(table)) + ", " + options.channel + " in sr^-1 at " +
                     nanometre_text(options.wavelengths) + ", steps of " + shortest(step) +
                     " degrees about the specular ray; below the horizon the values on it; TIS is the reflectance of "
                     "each incidence";
  if (const auto negative = std::ranges::count_if(table.values(), [](double v) { return v < 0; }); negative > 0)
    text += "; " + std::to_string(negative) + " of " + std::to_string(table.values().size()) + " values are negative";
  return text;
}

}  // namespace

Export::Made make_zemax(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "a Zemax");
  const Channel channel = channel_of(model, options.channel);
  const PreparedModel prepared = prepare(model, one_wavelength(options, "a Monochrome Zemax file"));
  const double theta_max = compared_up_to(model);
  const std::vector<Geometry> compared = random_geometries(4000, 1, theta_max);
  const bool symmetrical = options.channel == "f11" || is_its_own_mirror_image(prepared);
  std::shared_ptr<const SpecularTable> table;
  ExportError error;
  double step = 0;
  for (const double degrees : specular_steps) {
    step = degrees;
    table = std::make_shared<const SpecularTable>(prepared, channel, step, symmetrical);
    error = error_of(*table, prepared, channel, compared, theta_max);
    if (error.rms <= options.error) break;
  }
  require_error(error, options, "steps of " + shortest(step) + " degrees");
  constexpr int many_nodes = 16;  // exact for f11 and enough for quantities, which are smooth
  std::vector<double> tis;
  for (std::size_t i = 0; i < table->incidences(); ++i)
    tis.push_back(total_scatter(prepared, channel, table->theta_i(i), std::max(many_nodes, hemisphere_nodes(model))));
  const auto write = [table, tis, head = zemax_head(*table, model, options)](std::ostream& out) {
    out << head;
    table->write(out, tis);
  };
  return {write, error, zemax_understood(*table, options, step)};
}

}  // namespace mmbrdf
