// SPDX-License-Identifier: BSD-3-Clause
// Models as tables of other programs.

#include "mmbrdf/formats/export.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <ostream>

#include "bindings.hpp"
#include "mmbrdf/files/write_file.hpp"

namespace mmbrdf::python {

namespace {

std::string exported(const ModelObject& o, const std::filesystem::path& path, const std::optional<std::string>& format,
                     const std::optional<Given>& wavelength_nm, const std::string& channel, double error, int streams,
                     int moments, const std::optional<Given>& sun_deg, const std::optional<Given>& view_deg,
                     const std::optional<Given>& azimuth_deg) {
  require_place(path);
  const auto angles = [](const char* name, const std::optional<Given>& degrees) {
    std::vector<double> result = degrees ? numbers(name, *degrees) : std::vector<double>();
    std::ranges::transform(result, result.begin(), radians);
    return result;
  };
  ExportOptions options{.channel = channel, .error = error};
  options.transfer = {streams, moments, angles("sun_deg", sun_deg), angles("view_deg", view_deg),
                      angles("azimuth_deg", azimuth_deg)};
  if (wavelength_nm) options.wavelengths = micrometres(numbers("wavelength_nm", *wavelength_nm));
  const ExportFormat& as = format ? export_format(*format) : export_format_of(path.string());
  return without_gil([&] {
    const Export table(o.model(), as, options);
    write_file(path, [&](std::ostream& out) { table.write(out); });
    return table.understood();
  });
}

/// With the formats that there are.
std::string export_doc() {
  std::string text =
      "Writes a table that another program reads, in the format of this name, or that which the path's ending says:\n";
  for (const ExportFormat& format : export_formats())
    text += "    " + std::string(format.name) + " (" + std::string(format.ending) +
            "): " + std::string(format.meaning) + "\n";
  return text +
         "Programs interpolate in it: the coarsest is taken whose rms error is at most `error`, as a part of f11. "
         "Returns\n"
         "what was written, in words. Raises OSError if it cannot be written, ValueError with the reason for what the\n"
         "format cannot hold; nothing is half-written.\n\n"
         "wavelength_nm  those of the fit if not given\n"
         "channel        what a format without polarization holds: f11, or a quantity in sr^-1\n"
         "streams        of vlidort: cosines in a hemisphere; moments: how many, 2 x streams if 0\n"
         "sun_deg, view_deg, azimuth_deg  of vlidort and 6s: polar angles, and phi_r - phi_i, 180 is forward";
}

}  // namespace

void bind_export(ModelClass& model) {
  model.def("export", exported, py::arg("path"), py::arg("format") = py::none(), py::kw_only(),
            py::arg("wavelength_nm") = py::none(), py::arg("channel") = "f11", py::arg("error") = ExportOptions{}.error,
            py::arg("streams") = 0, py::arg("moments") = 0, py::arg("sun_deg") = py::none(),
            py::arg("view_deg") = py::none(), py::arg("azimuth_deg") = py::none(), export_doc().c_str());
}

}  // namespace mmbrdf::python
