// SPDX-License-Identifier: BSD-3-Clause
// The lines with which 6S is told of a surface of the user's own. Part of transfer.hpp.

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "formats/export_table.hpp"
#include "formats/reader.hpp"
#include "formats/transfer.hpp"
#include "mmbrdf/model/moments.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

using std::numbers::pi;

constexpr std::array zeniths{0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0};
constexpr int azimuth_step = 30;

struct Surface {
  std::array<std::array<std::array<double, 10>, 13>, 2> tables{};  // for the sun at its angle, and at that of the view
  double albedo = 0, reflectance = 0;
};

/// Reflected per incident flux under uniform illumination, ∫∫ 4 μ_i μ_r π f dμ_i dμ_r of the mean over azimuth.
double spherical_albedo(const PreparedModel& model, const Channel& value) {
  const std::vector<Node> nodes = gauss_legendre(32);
  std::vector<double> cosines;
  for (const Node& node : nodes) cosines.push_back(node.x);
  const std::vector<FourierMoments> all = fourier_moments(model, cosines, cosines);
  double sum = 0;
  for (std::size_t r = 0; r < nodes.size(); ++r)
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += 4 * pi * nodes[r].x * nodes[r].weight * nodes[i].x * nodes[i].weight *
             value(all[r * nodes.size() + i].cosine[0]);
  return sum;
}

void write_surface(std::ostream& out, const Surface& surface) {
  out << "0 homogeneous surface\n1 directional effects\n0 user's own values\n";
  for (const auto& table : surface.tables)
    for (const auto& of_azimuth : table) {
      std::string line;
      for (const double value : of_azimuth) line += (line.empty() ? "" : " ") + fixed(value, 7);
      out << line << '\n';
    }
  out << fixed(surface.albedo, 7) << '\n' << fixed(surface.reflectance, 7) << '\n';
}

}  // namespace

Export::Made make_sixs(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "a 6S");
  const TransferAngles& angles = options.transfer;
  if (angles.streams != 0 || angles.moments != 0)
    throw std::invalid_argument("a 6S file has neither streams nor moments");
  if (angles.suns.size() != 1 || angles.views.size() != 1 || angles.azimuths.size() != 1)
    throw std::invalid_argument("a 6S file is for one sun, one view and the azimuth between them: tell all three");
  require_polar_angles(angles.suns, "the sun");
  require_polar_angles(angles.views, "the view");
  require_azimuths(angles.azimuths);
  const PreparedModel prepared = prepare(model, one_wavelength(options, "a 6S file"));
  const auto value = channel_of(model, options.channel);
  const auto reflectance = [&](double sun, double view, double azimuth) {
    return pi * value(prepared.evaluate({{sun, 0}, {view, azimuth}}, Frame::sp));
  };
  const auto surface = std::make_shared<Surface>();
  long negative = 0;
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t a = 0; a < 13; ++a)
      for (std::size_t z = 0; z < 10; ++z) {
        // 6S counts the azimuths of its tables from that of the scene: its own surfaces are at φ + a, and at −φ + a for the
        // second.
        const double v =
            reflectance(t == 0 ? angles.suns[0] : angles.views[0], radians(zeniths[z]),
                        (t == 0 ? 1 : -1) * angles.azimuths[0] + radians(azimuth_step * static_cast<double>(a)));
        surface->tables[t][a][z] = v;
        negative += v < 0;
      }
  surface->albedo = spherical_albedo(prepared, value);
  surface->reflectance = reflectance(angles.suns[0], angles.views[0], angles.azimuths[0]);
  std::string understood = "pi " + options.channel + " at " + nanometre_text(options.wavelengths) + " for the sun at " +
                           shortest(in_degrees(angles.suns[0])) + " degrees, then at that of the view, " +
                           shortest(in_degrees(angles.views[0])) +
                           "; a line for each azimuth, 0 to 360 by 30 from that of the scene, of 10 zeniths, 0 to 85; "
                           "spherical albedo " +
                           rounded(surface->albedo, 6) + ", reflectance of the scene " +
                           rounded(surface->reflectance, 6);
  if (negative > 0) understood += "; " + std::to_string(negative) + " of 260 values are negative";
  return {[surface](std::ostream& out) { write_surface(out, *surface); }, {}, understood};
}

}  // namespace mmbrdf
