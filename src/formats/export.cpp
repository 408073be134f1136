// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/formats/export.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "formats/astm.hpp"
#include "formats/bird.hpp"
#include "formats/export_table.hpp"
#include "formats/klems.hpp"
#include "formats/mqdiffuse.hpp"
#include "formats/netcdf.hpp"
#include "formats/pbsdf.hpp"
#include "formats/reader.hpp"
#include "formats/rgl.hpp"
#include "formats/transfer.hpp"
#include "formats/zemax.hpp"
#include "mmbrdf/model/description.hpp"
#include "mmbrdf/quantities/quantities.hpp"
#include "mmbrdf/quantities/trust.hpp"
#include "mmbrdf/text/rounding.hpp"
#include "mmbrdf/text/units.hpp"
#include "text/numbers.hpp"

namespace mmbrdf {
namespace {

struct Writer {
  ExportFormat format;
  Export::Made (*make)(const Model& model, const ExportOptions& options);
};

constexpr std::array writers{
    Writer{{"pbsdf", ".pbsdf", "Mitsuba's measured_polarized: Mueller matrices of an isotropic sample", false},
           make_pbsdf},
    Writer{{"astm", ".astm", "ASTM E2387 text: one number at each geometry of an isotropic sample", true}, make_astm},
    Writer{{"zemax", ".bsdf", "Zemax tabular BSDF text: one number at each geometry, one wavelength", true},
           make_zemax},
    Writer{{.name = "bird",
            .ending = ".brdf",
            .meaning = "BiRD JSON v1.0: values between polarization states, with uncertainties",
            .takes_channel = false,
            .takes_error = false},
           make_bird},
    Writer{{"rgl", ".bsdf", "RGL material for Mitsuba's measured and pbrt: one number at each geometry", true},
           make_rgl},
    Writer{{.name = "klems",
            .ending = ".xml",
            .meaning = "Radiance's XML: means of one number over Klems' 145 patches, one wavelength",
            .takes_channel = true,
            .takes_error = false},
           make_klems},
    Writer{
        {"netcdf", ".nc", "self-describing NetCDF-4: Mueller matrices of an isotropic sample, with u and flags", false},
        make_netcdf},
    Writer{{"mqdiffuse", ".mqdiffuse", "eradiate's measured quasi-diffuse surface, NetCDF: one number at each geometry",
            true},
           make_mqdiffuse},
    Writer{{"vlidort", ".vlidort", "VLIDORT's BRDF supplement: Fourier moments of all elements at its streams", false,
            true, false},
           make_vlidort},
    Writer{{"6s", ".6s", "6S's user-defined surface: reflectances for one sun and one view", true, true, false},
           make_sixs},
};

constexpr auto written_formats = [] {
  std::array<ExportFormat, writers.size()> result{};
  for (std::size_t i = 0; i < writers.size(); ++i) result[i] = writers[i].format;
  return result;
}();

std::string all_formats() {
  std::string list;
  for (const ExportFormat& format : written_formats)
    list += (list.empty() ? "" : ", ") + std::string(format.name) + " (" + std::string(format.ending) + ")";
  return list;
}

const Writer& writer_of(const ExportFormat& format) {
  return *std::ranges::find(writers, format.name, [](const Writer& writer) { return writer.format.name; });
}

/// Options that a writer need not check again.
ExportOptions completed(const Model& model, const ExportFormat& format, ExportOptions options) {
  if (!(options.error > 0)) throw std::invalid_argument("error = " + shortest(options.error) + ", must be positive");
  if (!format.takes_channel && options.channel != "f11")
    throw std::invalid_argument("channel " + in_quotes(options.channel) + ": a " + std::string(format.ending) +
                                " file holds whole matrices");
  if (!format.takes_transfer && options.transfer != TransferAngles{})
    throw std::invalid_argument("a " + std::string(format.name) +
                                " file has angles of its own: leave out those of radiative transfer");
  if (options.wavelengths.empty()) options.wavelengths = known_wavelengths(model);
  if (options.wavelengths.empty()) throw std::invalid_argument("the model does not say its wavelengths: tell them");
  std::ranges::sort(options.wavelengths);
  const auto twice = std::ranges::adjacent_find(options.wavelengths);
  if (twice != options.wavelengths.end())
    throw std::invalid_argument("wavelength " + shortest(in_nanometres(*twice)) + " nm is given twice");
  return options;
}

/// "; 100 and 200 nm lie beyond the fitted wavelengths; 450 nm lies between fitted wavelengths"
std::string wavelengths_text(const Validity& validity, const std::vector<double>& wavelengths) {
  std::vector<double> beyond, between;
  for (const double wavelength : wavelengths) {
    const Outside where = outside(validity, wavelength);
    if (where & outside_wavelength) beyond.push_back(wavelength);
    if (where & interpolated) between.push_back(wavelength);
  }
  const auto lie = [](const std::vector<double>& some, const std::string& where) {
    return some.empty() ? "" : "; " + nanometre_text(some) + (some.size() == 1 ? " lies " : " lie ") + where;
  };
  return lie(beyond, "beyond the fitted wavelengths") + lie(between, "between fitted wavelengths");
}

/// Of the wavelength at which samples support the least.
std::string unsupported_text(const Validity& validity, const std::vector<double>& wavelengths) {
  const std::size_t count = validity.supported.size() > 1 ? wavelengths.size() : 1;  // one set holds for all
  const double emptiest = *std::ranges::max_element(std::span(wavelengths).first(count), {},
                                                    [&](double w) { return unsupported_share(validity, w); });
  const std::string line = unsupported_line(validity, emptiest);
  return line.empty() ? "" : "; " + line;
}

}  // namespace

std::span<const ExportFormat> export_formats() { return written_formats; }

const ExportFormat& export_format(std::string_view name) {
  const auto* const found = std::ranges::find(written_formats, name, &ExportFormat::name);
  if (found == written_formats.end())
    throw std::invalid_argument(in_quotes(name) + ": no such format; there are " + all_formats());
  return *found;
}

const ExportFormat& export_format_of(std::string_view path) {
  const auto has_it = [&](const ExportFormat& format) { return path.ends_with(format.ending); };
  const auto* const found = std::ranges::find_if(written_formats, has_it);
  if (found == written_formats.end())
    throw std::invalid_argument(in_quotes(path) + ": no format has this ending; there are " + all_formats());
  const auto* const other = std::find_if(found + 1, written_formats.end(), has_it);
  if (other != written_formats.end())
    throw std::invalid_argument(in_quotes(path) + ": " + std::string(found->name) + " and " + std::string(other->name) +
                                " have this ending: name one of them");
  return *found;
}

Export::Export(Made made)
    : write_(std::move(made.write)),
      error_(made.error),
      understood_(std::move(made.understood)),
      extrapolates_(made.extrapolates) {
  if (error_.theta_max == 0) return;
  understood_ += "; " + made.cause + " adds " + rounded(100 * error_.rms, 2) + " % of f11 (rms; at most " +
                 rounded(100 * error_.largest, 2) + " %) up to " + rounded(in_degrees(error_.theta_max), 4) +
                 " degrees";
}

Export::Export(const Model& model, const ExportFormat& format, const ExportOptions& options)
    : Export(writer_of(format).make(model, completed(model, format, options))) {
  const std::vector<double> wavelengths = completed(model, format, options).wavelengths;
  const std::string at = wavelengths_text(model.validity, wavelengths);
  const bool leaves =
      std::ranges::any_of(wavelengths, [&](double w) { return leaves_known_range(outside(model.validity, w)); });
  if (const std::string range = fitted_range(model.validity); !range.empty() && (extrapolates_ || leaves))
    understood_ += "; beyond its fitted range, " + range + ", the model is extrapolated";
  understood_ += at;
  if (extrapolates_) understood_ += unsupported_text(model.validity, wavelengths);
}

double compared_up_to(const Model& model) {
  constexpr double some_degrees = radians(1);
  const double fitted = std::min({compared_theta, model.validity.theta_i_max.value_or(compared_theta),
                                  model.validity.theta_r_max.value_or(compared_theta)});
  return fitted < some_degrees ? radians(30) : fitted;
}

void require_error(const ExportError& error, const ExportOptions& options, const std::string& table) {
  if (!std::isfinite(error.rms))
    throw std::invalid_argument("f11 of the model is 0 at directions up to " + rounded(in_degrees(error.theta_max), 4) +
                                " degrees: the error of a table, a part of f11, cannot be told");
  if (error.rms > options.error)
    throw std::invalid_argument("the finest table, of " + table + ", has an rms error of " +
                                rounded(100 * error.rms, 2) + " % of f11, more than the " +
                                rounded(100 * options.error, 2) + " % asked for");
}

bool depends_on_azimuth_of_source(const Model& model) {
  return model.family == Family::anisotropic || model.rotation == Rotation::as_printed;
}

void require_isotropic(const Model& model, const std::string& format) {
  if (depends_on_azimuth_of_source(model))
    throw std::invalid_argument(format + " file is of an isotropic sample, and " +
                                azimuth_of_source_line(model.family));
}

Channel channel_of(const Model& model, const std::string& name) {
  if (name == "f11") return [](const Mueller& m) { return m(0, 0); };
  const Quantity& of_name = quantity(name);
  if (of_name.unit != "sr^-1" || of_name.takes_light)
    throw std::invalid_argument("channel " + name + ": must be f11, or a quantity in sr^-1 that takes no light");
  const Elements unknown = unknown_elements(model, Frame::sp);
  if ((of_name.needs & unknown).any())
    throw std::invalid_argument("channel " + name + ": " + not_measured_line(unknown_elements(model)));
  return [value = of_name.value](const Mueller& m) { return value(m, {}); };
}

double one_wavelength(const ExportOptions& options, const std::string& format) {
  if (options.wavelengths.size() > 1)
    throw std::invalid_argument(nanometre_text(options.wavelengths) + ": " + format + " has one wavelength: choose it");
  return options.wavelengths.front();
}

Vector3 raised(const Vector3& v) {
  if (v[2] > horizon) return v;
  const double across = std::hypot(v[0], v[1]), z = 2 * horizon, length = std::sqrt(1 - z * z);
  return across > 0 ? Vector3{length * v[0] / across, length * v[1] / across, z} : Vector3{length, 0, z};
}

}  // namespace mmbrdf
