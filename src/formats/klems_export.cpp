// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <ostream>
#include <vector>

#include "formats/export_table.hpp"
#include "formats/klems.hpp"
#include "formats/reader.hpp"
#include "mmbrdf/geometry/apertures.hpp"
#include "mmbrdf/model/prepared.hpp"
#include "mmbrdf/numerics/quadrature.hpp"
#include "mmbrdf/samples/samples.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

/// A row of patches: polar angles in degrees, and how many there are around. The first is about azimuth 0.
struct PatchRow {
  double lower, upper;
  std::size_t around;
};
constexpr std::array patch_rows{PatchRow{0, 5, 1},    PatchRow{5, 15, 8},   PatchRow{15, 25, 16},
                                PatchRow{25, 35, 20}, PatchRow{35, 45, 24}, PatchRow{45, 55, 24},
                                PatchRow{55, 65, 24}, PatchRow{65, 75, 16}, PatchRow{75, 90, 12}};
constexpr std::size_t patches = 145;
constexpr double full_turn = 2 * std::numbers::pi;

/// In the order of a table: rows from the normal on, azimuths rising.
std::size_t patch_of(const Direction& direction) {
  std::size_t first = 0, row = 0;
  while (row + 1 < patch_rows.size() && degrees(direction.theta) >= patch_rows[row].upper)
    first += patch_rows[row++].around;
  const double turns = direction.phi / full_turn, count = static_cast<double>(patch_rows[row].around);
  return first + static_cast<std::size_t>((turns - std::floor(turns)) * count + 0.5) % patch_rows[row].around;
}

/// Nodes in each patch, with weights of projected solid angle that add up to 1: Gauss's in the polar angle and, of
/// parts of a circle, in azimuth.
std::vector<std::vector<WeightedDirection>> patch_nodes() {
  constexpr int across = 4, along = 3, whole_circle = 8;
  std::vector<std::vector<WeightedDirection>> result;
  for (const PatchRow& row : patch_rows)
    for (std::size_t n = 0; n < row.around; ++n) {
      std::vector<Node> azimuths = gauss_legendre(along);
      if (row.around == 1) {
        azimuths.clear();
        for (int k = 0; k < whole_circle; ++k) azimuths.push_back({(k + 0.5) / whole_circle, 1.0 / whole_circle});
      }
      std::vector<WeightedDirection> nodes;
      double sum = 0;
      for (const Node& polar : gauss_legendre(across)) {
        const double theta = radians(row.lower + polar.x * (row.upper - row.lower));
        for (const Node& azimuth : azimuths) {
          const double phi = full_turn * (static_cast<double>(n) + azimuth.x - 0.5) / static_cast<double>(row.around);
          nodes.push_back({{theta, phi}, polar.weight * azimuth.weight * std::sin(theta) * std::cos(theta)});
          sum += nodes.back().weight;
        }
      }
      for (WeightedDirection& node : nodes) node.weight /= sum;
      result.push_back(std::move(nodes));
    }
  return result;
}

/// Means over pairs of patches: a line for each patch of the light, in it a place for each patch in which the receiver is
/// seen turned by 180 degrees, so that mirror directions are on the diagonal.
std::vector<double> patch_means(const PreparedModel& model, const Channel& channel) {
  const std::vector<std::vector<WeightedDirection>> nodes = patch_nodes();
  std::vector<Direction> reflected;
  for (const auto& patch : nodes)
    for (const WeightedDirection& node : patch)
      reflected.push_back({node.direction.theta, node.direction.phi + std::numbers::pi});
  std::vector<Mueller> matrices(reflected.size());
  std::vector<double> means(patches * patches);
  for (std::size_t light = 0; light < patches; ++light)
    for (const WeightedDirection& from : nodes[light]) {
      model.at(from.direction).evaluate(reflected, Frame::sp, matrices);
      std::size_t at = 0;
      for (std::size_t seen = 0; seen < patches; ++seen)
        for (const WeightedDirection& to : nodes[seen])
          means[light * patches + seen] += from.weight * to.weight * channel(matrices[at++]);
    }
  return means;
}

/// What a reader finds, one value in each patch, beside what the model gives.
ExportError error_of(const std::vector<double>& means, const PreparedModel& model, const Channel& channel,
                     double theta_max) {
  Deviation deviation;
  for (const Geometry& geometry : random_geometries(4000, 1, theta_max)) {
    const Direction seen{geometry.reflected.theta, geometry.reflected.phi + std::numbers::pi};
    const Mueller m = model.evaluate(geometry, Frame::sp);
    deviation.add(means[patch_of(geometry.incident) * patches + patch_of(seen)], channel(m), m(0, 0));
  }
  return deviation.error(theta_max);
}

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return result;
}

std::string basis_xml() {
  std::string text = "<AngleBasis>\n<AngleBasisName>LBNL/Klems Full</AngleBasisName>\n";
  for (const PatchRow& row : patch_rows) {
    const double middle = row.lower > 0 ? (row.lower + row.upper) / 2 : 0;
    text += "<AngleBasisBlock><Theta>" + shortest(middle) + "</Theta><nPhis>" + std::to_string(row.around) +
            "</nPhis><ThetaBounds><LowerTheta>" + shortest(row.lower) + "</LowerTheta><UpperTheta>" +
            shortest(row.upper) + "</UpperTheta></ThetaBounds></AngleBasisBlock>\n";
  }
  return text + "</AngleBasis>\n";
}

void write_klems(std::ostream& out, const std::string& name, const std::vector<double>& means) {
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<WindowElement xmlns=\"http://windows.lbl.gov\">\n"
         "<WindowElementType>System</WindowElementType>\n<FileType>BSDF</FileType>\n<Optical>\n<Layer>\n"
         "<Material>\n<Name>"
      << xml_text(name)
      << "</Name>\n<Manufacturer>not stated</Manufacturer>\n<DeviceType>Other</DeviceType>\n</Material>\n"
         "<DataDefinition>\n<IncidentDataStructure>Columns</IncidentDataStructure>\n"
      << basis_xml()
      << "</DataDefinition>\n<WavelengthData>\n<LayerNumber>System</LayerNumber>\n"
         "<Wavelength unit=\"Integral\">Visible</Wavelength>\n<WavelengthDataBlock>\n"
         "<WavelengthDataDirection>Reflection Back</WavelengthDataDirection>\n"
         "<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>\n<RowAngleBasis>LBNL/Klems Full</RowAngleBasis>\n"
         "<ScatteringDataType>BRDF</ScatteringDataType>\n<ScatteringData>\n";
  for (std::size_t light = 0; light < patches; ++light) {
    std::string line;
    for (std::size_t seen = 0; seen < patches; ++seen)
      line += (seen > 0 ? "\t" : "") + rounded(means[light * patches + seen], 8);
    out << line << '\n';
  }
  out << "</ScatteringData>\n</WavelengthDataBlock>\n</WavelengthData>\n</Layer>\n</Optical>\n</WindowElement>\n";
}

}  // namespace

Export::Made make_klems(const Model& model, const ExportOptions& options) {
  const Channel channel = channel_of(model, options.channel);
  const PreparedModel prepared = prepare(model, one_wavelength(options, "a Klems XML file"));
  const auto means = std::make_shared<const std::vector<double>>(patch_means(prepared, channel));
  const std::string at = " at " + nanometre_text(options.wavelengths);
  std::string understood = options.channel + " in sr^-1" + at +
                           ", means over pairs of the 145 patches of Klems' full basis, as Visible reflection from the "
                           "side of +z (\"Reflection Back\")";
  if (const auto negative = std::ranges::count_if(*means, [](double v) { return v < 0; }); negative > 0)
    understood += "; " + std::to_string(negative) + " of " + std::to_string(means->size()) +
                  " are negative, which Radiance takes for 0";
  const std::string name = printable(model.name.empty() ? "mmbrdf" : model.name, 60) + ", " + options.channel + at;
  const auto write = [means, name](std::ostream& out) { write_klems(out, name, *means); };
  return {write, error_of(*means, prepared, channel, compared_up_to(model)), understood, "the width of the patches"};
}

}  // namespace mmbrdf
