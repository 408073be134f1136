// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "formats/export_table.hpp"
#include "formats/half_difference.hpp"
#include "formats/pbsdf.hpp"
#include "formats/tensor_file.hpp"
#include "mmbrdf/model/batch.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// Nodes of phi_d, both ends of the circle among them, of theta_d and theta_h.
using NodeCounts = std::array<std::size_t, 3>;
constexpr std::array<NodeCounts, 3> grids{{{37, 19, 19}, {73, 46, 46}, {121, 61, 61}}};

std::string to_string(const NodeCounts& grid) {
  return std::to_string(grid[0]) + " phi_d, " + std::to_string(grid[1]) + " theta_d, " + std::to_string(grid[2]) +
         " theta_h";
}

std::vector<float> axis(double first, double last, std::size_t nodes) {
  std::vector<float> result(nodes);
  for (std::size_t k = 0; k < nodes; ++k)
    result[k] = static_cast<float>(first + (last - first) * static_cast<double>(k) / static_cast<double>(nodes - 1));
  return result;
}

Vector3 perpendicular(const Vector3& i, const Vector3& o) {
  const Vector3 n{i[1] * o[2] - i[2] * o[1], i[2] * o[0] - i[0] * o[2], i[0] * o[1] - i[1] * o[0]};
  const double length = std::hypot(n[0], n[1], n[2]), across = std::hypot(i[0], i[1]);
  if (length > parallel_limit) return {n[0] / length, n[1] / length, n[2] / length};
  return {-i[1] / across, i[0] / across, 0};  // both on the horizon, where one was raised
}

/// The table needs numbers everywhere: of what is below the horizon those of the nearest directions on it.
NodeAxes node(double theta_h, double theta_d, double phi_d) {
  const HalfDifference at = half_difference(theta_h, theta_d, phi_d);
  if (above_horizon(at)) return NodeAxes(at);
  const Vector3 i = raised(at.incident), o = raised(at.reflected);
  return NodeAxes({i, o, perpendicular(i, o)});
}

Mueller as_stored(const Mueller& m_xy, const NodeAxes& axes) {
  return convert(transpose(axes.left) * m_xy * transpose(axes.right), StokesConvention::germer2017,
                 StokesConvention::s_first_right);
}

class Table {
 public:
  Table(const std::vector<PreparedModel>& models, const NodeCounts& grid)
      : grid_(grid),
        wavelengths_(models.size()),
        phi_d_(axis(-std::numbers::pi, std::numbers::pi, grid[0])),
        theta_d_(axis(0, half_pi, grid[1])),
        theta_h_(axis(0, half_pi, grid[2])),
        m_(16 * models.size() * grid[0] * grid[1] * grid[2]) {
    std::vector<NodeAxes> nodes;
    std::vector<Geometry> geometries;
    std::vector<Mueller> matrices(grid[1] * grid[2]);
    for (std::size_t p = 0; p < grid[0]; ++p) {
      nodes.clear(), geometries.clear();
      for (const float theta_d : theta_d_)
        for (const float theta_h : theta_h_)
          geometries.push_back(nodes.emplace_back(node(theta_h, theta_d, phi_d_[p])).geometry);
      for (std::size_t w = 0; w < models.size(); ++w) {
        evaluate(models[w], geometries, matrices);
        for (std::size_t n = 0; n < nodes.size(); ++n) {
          const Mueller m = as_stored(matrices[n], nodes[n]);
          std::ranges::transform(m.elements, at(p * nodes.size() + n, w),
                                 [](double e) { return static_cast<float>(e); });
          if (!(m(0, 0) > 0)) ++dark_;
        }
      }
    }
  }

  /// As the reader does: linear along each axis, without regard to what an angle means.
  Mueller looked_up(const HalfAngles& angles, std::size_t w) const {
    const auto [p, along_p] = place(angles.phi_d / (2 * std::numbers::pi) + 0.5, grid_[0]);
    const auto [d, along_d] = place(angles.theta_d / half_pi, grid_[1]);
    const auto [h, along_h] = place(angles.theta_h / half_pi, grid_[2]);
    Mueller sum{};
    for (const std::size_t corner : {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U}) {
      const std::size_t a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
      const double weight = (a ? along_p : 1 - along_p) * (b ? along_d : 1 - along_d) * (c ? along_h : 1 - along_h);
      const float* const m = at(((p + a) * grid_[1] + d + b) * grid_[2] + h + c, w);
      for (std::size_t e = 0; e < 16; ++e) sum.elements[e] += weight * static_cast<double>(m[e]);
    }
    return sum;
  }

  ExportError error(const std::vector<PreparedModel>& models, double theta_max) const {
    constexpr int count = 4000;
    Deviation deviation;
    const std::vector<Geometry> geometries = random_geometries(count, 1, theta_max);
    for (std::size_t w = 0; w < models.size(); ++w)
      for (const Geometry& geometry : geometries) {
        const Vector3 i = unit_vector(geometry.incident), o = unit_vector(geometry.reflected);
        const NodeAxes axes({i, o, perpendicular(i, o)});
        const Mueller expected = as_stored(models[w].evaluate(axes.geometry), axes);
        const Mueller found = looked_up(half_angles(i, o), w);
        for (std::size_t e = 0; e < 16; ++e) deviation.add(found.elements[e], expected.elements[e], expected(0, 0));
      }
    return deviation.error(theta_max);
  }

  void write(std::ostream& out, const std::vector<std::uint16_t>& nanometres) const {
    const auto angles = [](const std::string& name, const std::vector<float>& values) {
      return NewTensor{.name = name, .shape = {1, values.size()}, .singles = values};
    };
    // M last: Mitsuba reads ten bytes of wavelengths even if there are fewer.
    write_tensor_file(
        out,
        std::array{angles("phi_d", phi_d_), angles("theta_d", theta_d_), angles("theta_h", theta_h_),
                   NewTensor{.name = "wvls", .shape = {nanometres.size()}, .whole = nanometres},
                   NewTensor{.name = "M", .shape = {grid_[0], grid_[1], grid_[2], wavelengths_, 4, 4}, .singles = m_}});
  }

  /// Nodes where f11 is not positive, which a renderer takes for black.
  std::size_t dark() const { return dark_; }

 private:
  float* at(std::size_t node, std::size_t w) { return m_.data() + 16 * (node * wavelengths_ + w); }
  const float* at(std::size_t node, std::size_t w) const { return m_.data() + 16 * (node * wavelengths_ + w); }

  static std::pair<std::size_t, double> place(double part, std::size_t nodes) {
    const double x = std::clamp(part, 0.0, 1.0) * static_cast<double>(nodes - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(x), nodes - 2);
    return {below, x - static_cast<double>(below)};
  }

  NodeCounts grid_;
  std::size_t wavelengths_, dark_ = 0;
  std::vector<float> phi_d_, theta_d_, theta_h_, m_;
};

std::vector<std::uint16_t> whole_nanometres(const std::vector<double>& wavelengths) {
  constexpr std::size_t most = 5;
  if (wavelengths.size() > most)
    throw std::invalid_argument(std::to_string(wavelengths.size()) +
                                " wavelengths: Mitsuba reads at most 5 of a .pbsdf file");
  std::vector<std::uint16_t> result;
  for (const double wavelength : wavelengths) {
    const double nm = in_nanometres(wavelength);
    if (!(std::abs(nm - std::round(nm)) < 1e-6 && nm > 0.5 && nm < 65535.5))
      throw std::invalid_argument("wavelength " + shortest(nm) + " nm: a .pbsdf file has whole nanometres up to 65535");
    const auto whole = static_cast<std::uint16_t>(std::lround(nm));
    if (!result.empty() && result.back() == whole)
      throw std::invalid_argument("wavelength " + std::to_string(whole) + " nm is given twice, to whole nanometres");
    result.push_back(whole);
  }
  return result;
}

}  // namespace

Export::Made make_pbsdf(const Model& model, const ExportOptions& options) {
  require_isotropic(model, "a .pbsdf");
  if (const Elements unknown = unknown_elements(model); unknown.any())
    throw std::invalid_argument("a .pbsdf file holds all sixteen elements; " + not_measured_line(unknown));
  const std::vector<std::uint16_t> nanometres = whole_nanometres(options.wavelengths);
  std::vector<PreparedModel> models;
  for (const double wavelength : options.wavelengths) models.push_back(prepare(model, wavelength));
  const double theta_max = compared_up_to(model);
  std::shared_ptr<const Table> table;
  ExportError error;
  const NodeCounts* grid = grids.data();
  for (;; ++grid) {
    table = std::make_shared<const Table>(models, *grid);
    error = table->error(models, theta_max);
    if (error.rms <= options.error || grid == &grids.back()) break;
  }
  require_error(error, options, to_string(*grid));
  std::string understood = to_string(*grid) + " at " + nanometre_text(options.wavelengths) +
                           "; f_ij in sr^-1 about the scattering plane, S4 > 0 right-handed";
  if (table->dark() > 0)
    understood += "; f11 is not positive at " + std::to_string(table->dark()) + " nodes, which are black to a renderer";
  return {[table, nanometres](std::ostream& out) { table->write(out, nanometres); }, error, understood};
}

}  // namespace mmbrdf
