// SPDX-License-Identifier: BSD-3-Clause
// Samples.
#include "dataset.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/formats/foreign.hpp"
#include "mmbrdf/samples/simulation.hpp"
#include "pickles.hpp"

namespace mmbrdf::python {

namespace {

DatasetPointer pointer(std::vector<Sample> samples) { return std::make_shared<Dataset>(std::move(samples)); }

/// Some of the samples of a dataset, of the same origin.
DatasetPointer of_same(const Dataset& data, std::vector<Sample> samples) {
  DatasetPointer result = pointer(std::move(samples));
  result->read_as = data.read_as;
  result->reduction = data.reduction;
  return result;
}

/// mueller as measured (sr⁻¹) in a frame → samples. Uncertainties are of f11 and of normalised elements, in that frame.
DatasetPointer from_arrays(const Given& wavelength_nm, const Given& theta_i, const Given& phi_i, const Given& theta_r,
                           const Given& phi_r, const Given& mueller, const std::string& frame_name,
                           const std::optional<Given>& uncertainty) {
  const Frame frame = frame_from(frame_name);
  std::vector<Operand> operands = direction_operands(theta_i, phi_i, theta_r, phi_r);
  operands.push_back({"wavelength_nm", wavelength_nm});
  operands.push_back({"mueller", mueller, {4, 4}});
  if (uncertainty) operands.push_back({"uncertainty", *uncertainty, {4, 4}});
  const Broadcast broadcast(operands);
  return without_gil([&] {
    std::vector<Sample> samples(broadcast.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      Sample& sample = samples[i];
      sample.geometry = geometry(broadcast, 0, i);
      sample.wavelength = micrometres(broadcast.number(4, i));
      const Mueller m = broadcast.mueller(5, i);
      sample.f11 = m(0, 0);
      sample.normalized = normalized(m);
      if (uncertainty) sample.uncertainty = broadcast.mueller(6, i);
    }
    require_valid(samples);  // as they were given: turned, a negative uncertainty is a positive one
    if (frame != Frame::xy)
      for (Sample& sample : samples) sample = from_frame(sample, frame);
    return pointer(std::move(samples));
  });
}

/// One number of each sample.
template <class F>
auto column(const Dataset& data, F f) {
  py::array_t<std::invoke_result_t<F, const Sample&>> result(static_cast<py::ssize_t>(data.samples.size()));
  auto* const out = result.mutable_data();
  for (std::size_t i = 0; i < data.samples.size(); ++i) out[i] = f(data.samples[i]);
  return result;
}

/// A member of each sample, without a copy.
py::array matrices(Dataset& data, Mueller Sample::*member) {
  constexpr auto step = static_cast<py::ssize_t>(sizeof(Sample)), size = static_cast<py::ssize_t>(sizeof(double));
  const Sample* const first = data.samples.data();
  return view(first ? (first->*member).elements.data() : nullptr, {static_cast<py::ssize_t>(data.samples.size()), 4, 4},
              {step, 4 * size, size}, py::cast(data.shared_from_this()));
}

py::array_t<double> mueller(const Dataset& data) {
  const auto count = static_cast<py::ssize_t>(data.samples.size());
  py::array_t<double> result({count, py::ssize_t{4}, py::ssize_t{4}});
  double* out = result.mutable_data();
  for (const Sample& sample : data.samples)
    for (std::size_t e = 0; e < 16; ++e) *out++ = sample.f11 * sample.normalized.elements[e];
  return result;
}

/// Names of frames.
py::object frames(const Dataset& data) {
  const py::list names =
      py::cast(std::array{to_string(Frame::xy), to_string(Frame::sp), to_string(Frame::scattering_plane)});
  const auto which = column(data, [](const Sample& s) { return static_cast<std::int8_t>(own_frame(s)); });
  return py::module_::import("numpy").attr("array")(names)[which];
}

py::array_t<double> as_measured(const Dataset& data) {
  std::vector<Mueller> result;
  result.reserve(data.samples.size());
  for (const Sample& sample : data.samples) result.push_back(in_own_frame(sample).normalized);
  return array_of(result);
}

bool has_uncertainty(const Dataset& data) {
  return std::ranges::any_of(data.samples, [](const Sample& s) { return has_uncertainty(in_own_frame(s)); });
}

/// What data[which] keeps: numpy decides, on the numbers of the samples.
DatasetPointer chosen(const Dataset& data, const py::object& which) {
  require_unmasked("which", which);
  const py::object numbers = py::module_::import("numpy").attr("arange")(data.samples.size());
  const auto kept = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(
      py::module_::import("numpy").attr("atleast_1d")(numbers[which]));
  std::vector<Sample> samples;
  for (py::ssize_t i = 0; i < kept.size(); ++i)
    samples.push_back(data.samples[static_cast<std::size_t>(kept.data()[i])]);
  return of_same(data, std::move(samples));
}

py::tuple wavelengths_nm(const Dataset& data) {
  std::vector<double> result;
  for (const double wavelength : wavelengths(data.samples)) result.push_back(nanometres(wavelength));
  return py::tuple(py::cast(result));
}

std::string representation(const Dataset& data) {
  const std::vector<double> at = wavelengths(data.samples);
  std::string text = "<mmbrdf.Dataset: " + std::to_string(data.samples.size()) + " samples";
  for (std::size_t i = 0; i < at.size(); ++i)
    text += (i > 0 ? ", " : " at ") + formatted("{:g}", nanometres(at[i])) + (i + 1 == at.size() ? " nm" : "");
  return text + (has_uncertainty(data) ? ", with uncertainties>" : ">");
}

DatasetPointer samples_of(const std::filesystem::path& path, const ColumnNames& columns, bool skip_incomplete,
                          const std::optional<std::string>& frame, const std::string& convention) {
  SampleTable table{columns, skip_incomplete, {}, convention_from(convention)};
  if (frame) table.frame = frame_from(*frame);
  require_readable(path);
  return without_gil([&] {
    std::ifstream in = open_input(path);
    SampleReader reader(in, path, table);
    std::vector<Sample> samples;
    for (Sample sample; reader.next(sample);) samples.push_back(sample);
    DatasetPointer data = pointer(std::move(samples));
    data->read_as = reader.understood();
    data->reduction = reader.reduction();
    return data;
  });
}

DatasetPointer foreign_samples_of(const std::filesystem::path& path, const std::optional<Given>& wavelength_nm) {
  require_readable(path);
  ForeignOptions options;
  options.told_by = "wavelength_nm=";
  if (wavelength_nm) options.wavelengths = micrometres(numbers("wavelength_nm", *wavelength_nm));
  return without_gil([&] {
    ForeignFile file(path, options);
    std::vector<Sample> samples;
    file.read([&](std::span<const Sample> some) { samples.insert(samples.end(), some.begin(), some.end()); });
    DatasetPointer data = pointer(std::move(samples));
    data->read_as = file.understood();
    return data;
  });
}

DatasetPointer simulated(const ModelObject& model, const std::vector<double>& wavelengths_nm,
                         const py::sequence& angles, double speckle, unsigned long seed) {
  const std::vector<Geometry> geometries = geometries_from(angles);
  return without_gil(
      [&] { return pointer(simulate(model.model(), micrometres(wavelengths_nm), geometries, speckle, seed)); });
}

/// A sample without what was measured in another frame, which is pickled apart.
struct InXy {
  double wavelength;
  Geometry geometry;
  double f11;
  Mueller normalized, uncertainty;
  std::uint64_t given_in;  // a Frame, without bits that mean nothing
};
struct Apart {
  std::size_t sample;
  AsMeasured as_measured;
};

py::tuple pickled(const Dataset& data) {
  std::vector<InXy> in_xy;
  std::vector<Apart> apart;
  for (const Sample& s : data.samples) {
    if (s.as_measured) apart.push_back({in_xy.size(), *s.as_measured});
    in_xy.push_back(
        {s.wavelength, s.geometry, s.f11, s.normalized, s.uncertainty, static_cast<std::uint64_t>(s.given_in)});
  }
  return py::make_tuple(bits<InXy>("Dataset", in_xy), bits<Apart>("Dataset as measured", apart), data.read_as,
                        data.reduction);
}

DatasetPointer unpickled(const py::tuple& state) {
  if (state.size() != 4) throw std::invalid_argument("Dataset: not pickled by this version of mmbrdf");
  std::vector<Sample> samples;
  for (const InXy& s : from_bits<InXy>("Dataset", state[0])) {
    if (s.given_in > static_cast<std::uint64_t>(Frame::scattering_plane))
      throw std::invalid_argument("Dataset: the pickle is damaged");
    samples.push_back(
        {s.wavelength, s.geometry, s.f11, s.normalized, s.uncertainty, {}, static_cast<Frame>(s.given_in)});
  }
  for (const auto& [sample, as_measured] : from_bits<Apart>("Dataset as measured", state[1])) {
    if (sample >= samples.size() || (as_measured.frame != Frame::sp && as_measured.frame != Frame::scattering_plane))
      throw std::invalid_argument("Dataset: the pickle is damaged");
    samples[sample].as_measured = std::make_shared<const AsMeasured>(as_measured);
  }
  require_valid(samples);
  const DatasetPointer data = pointer(std::move(samples));
  data->read_as = state[2].cast<std::string>();
  data->reduction = state[3].cast<std::string>();
  return data;
}

void bind_columns(py::class_<Dataset, DatasetPointer>& c) {
  c.def_property_readonly(
       "wavelength_nm",
       [](const Dataset& d) { return column(d, [](const Sample& s) { return nanometres(s.wavelength); }); }, "(N,)")
      .def_property_readonly(
          "theta_i_deg",
          [](const Dataset& d) {
            return column(d, [](const Sample& s) { return degrees(s.geometry.incident.theta); });
          },
          "(N,), from 0 to 90")
      .def_property_readonly(
          "phi_i_deg",
          [](const Dataset& d) { return column(d, [](const Sample& s) { return degrees(s.geometry.incident.phi); }); },
          "(N,)")
      .def_property_readonly(
          "theta_r_deg",
          [](const Dataset& d) {
            return column(d, [](const Sample& s) { return degrees(s.geometry.reflected.theta); });
          },
          "(N,), from 0 to 90")
      .def_property_readonly(
          "phi_r_deg",
          [](const Dataset& d) { return column(d, [](const Sample& s) { return degrees(s.geometry.reflected.phi); }); },
          "(N,)")
      .def_property_readonly(
          "f11", [](const Dataset& d) { return column(d, [](const Sample& s) { return s.f11; }); },
          "(N,), the unpolarized BRDF in sr^-1");
}

void bind_matrices(py::class_<Dataset, DatasetPointer>& c) {
  c.def_property_readonly(
       "normalized", [](Dataset& d) { return matrices(d, &Sample::normalized); },
       "(N, 4, 4), f_ij / f11 in the xy frame, element 11 is 1, nan for what was not measured: a view")
      .def_property_readonly("mueller", mueller, "(N, 4, 4) in sr^-1, xy frame")
      .def_property_readonly("frame", frames,
                             "(N,) of text: in which frame the elements of a sample were measured, 'sp' or "
                             "'scattering_plane', if it loses\n"
                             "some on the way to xy; else 'xy', also of what was turned there whole")
      .def_property_readonly(
          "as_measured", as_measured,
          "(N, 4, 4), as `normalized`, each sample in its own `frame`: nan for what was not measured alone")
      .def_property_readonly(
          "uncertainty",
          [](Dataset& d) -> py::object {
            return has_uncertainty(d) ? py::object(matrices(d, &Sample::uncertainty)) : py::object(py::none());
          },
          "(N, 4, 4), standard uncertainties: element 11 of f11 in sr^-1, the others of f_ij / f11: a view. None: not "
          "known");
}

void bind_class(py::module_& m) {
  py::class_<Dataset, DatasetPointer> c(
      m, "Dataset",
      "Measured or simulated samples: N matrices, each at its own wavelength and geometry. It does not change.\n\n"
      "From read_samples(), simulate(), or arrays that broadcast to N: mueller (..., 4, 4) in sr^-1 in the frame "
      "named,\n"
      "and uncertainty (..., 4, 4), in that frame, too: element 11 of f11 in sr^-1, the others of f_ij / f11; they are "
      "turned\n"
      "as if errors of elements were independent. An element that was not measured is nan, here as in models: f11 must "
      "be "
      "there.\n"
      "Frames that turn axes mix 12 with 13, 21 with 31, 24 with 34, 42 with 43, and 22, 23, 32 and 33: in "
      "`normalized`, "
      "in xy,\n"
      "all of these are unknown where one is. fit() in the isotropic basis takes what was measured as it was.\n"
      "data[0:100], data[mask] and data[numbers] are datasets of fewer samples.");
  c.def(py::init(&from_arrays), py::arg("wavelength_nm"), py::arg("theta_i_deg"), py::arg("phi_i_deg"),
        py::arg("theta_r_deg"), py::arg("phi_r_deg"), py::arg("mueller"), py::arg("frame") = "xy",
        py::arg("uncertainty") = py::none());
  bind_columns(c);
  bind_matrices(c);
  c.def("__len__", [](const Dataset& d) { return d.samples.size(); })
      .def("__getitem__", chosen, py::arg("which"))
      .def("__repr__", representation)
      .def_property_readonly(
          "read_as", [](const Dataset& d) { return d.read_as; },
          "What of the table that it was read from is not as in the project's own, in words")
      .def_property_readonly(
          "reduction", [](const Dataset& d) { return d.reduction; },
          "From which readings the samples were made, and how, if that is known: reduce(), and files of it")
      .def_property_readonly("wavelengths_nm", wavelengths_nm, "The distinct wavelengths, rising")
      .def_property_readonly(
          "geometry",
          [](const Dataset& d) {
            std::vector<Geometry> all;
            for (const Sample& s : d.samples) all.push_back(s.geometry);
            return geometry_of(all);
          },
          "Geometry of all samples: four arrays (N,)")
      .def(
          "at_wavelengths",
          [](const Dataset& d, const Given& nm) {
            return of_same(d, at_wavelengths(d.samples, micrometres(numbers("wavelength_nm", nm))));
          },
          py::arg("wavelength_nm"), "Only the samples at these. Raises ValueError if there are none at one of them.")
      .def(
          "save",
          [](const Dataset& d, const std::filesystem::path& path) {
            if (d.samples.empty()) throw std::invalid_argument("a dataset without samples cannot be saved");
            require_place(path);
            write_samples(path, d.samples, d.reduction);
          },
          py::arg("path"), "Writes CSV, which reads back to the same bits. Raises OSError if it cannot be written.")
      .def(py::pickle(&pickled, &unpickled));
}

void bind_samples(py::module_& m) {
  m.def("read_samples", samples_of, py::arg("path"), py::kw_only(), py::arg("columns") = ColumnNames{},
        py::arg("skip_incomplete") = false, py::arg("frame") = py::none(), py::arg("convention") = "germer2017",
        "A Dataset from a table: the published layout, the project's own, or as other programs write it; read_as says "
        "what was\nunderstood. columns has other names, as in {'theta_i_deg': 'AOI'}, or numbers from 1; "
        "skip_incomplete passes over rows\nwith NA or NaN, or without an angle or wavelength; frame and convention are "
        "those of the matrices: as a column frame says, else xy,\nor sp of f_ss ... f_pp.\nRaises OSError for a file "
        "that cannot be read, with line "
        "and column for one that holds something else.");
  m.def(
      "read_foreign", foreign_samples_of, py::arg("path"), py::arg("wavelength_nm") = py::none(),
      "A Dataset from a measurement in another program's format, told by its content: ASTM E1392 and E2387, Zemax, "
      "ALTA, "
      "MERL,\nBiRD JSON, NetCDF, RGL .bsdf, Mitsuba's .pbsdf; read_as says how it was understood. wavelength_nm is "
      "what "
      "such a file does\nnot say: its wavelength, or one for each of its values at a geometry. All samples are held in "
      "memory. Raises OSError for a\nfile that cannot be read, with line, field or offset for one that holds something "
      "else.");
  m.def(
      "_holds_samples",
      [](const std::filesystem::path& path) {
        require_readable(path);
        return holds_samples(path);
      },
      py::arg("path"), "Whether a file begins as one of samples does, and none of a model.");
  m.def(
      "simulate",
      [](const ModelObject& model, const Given& nm, const py::sequence& geometry, double speckle, unsigned long seed) {
        return simulated(model, numbers("wavelength_nm", nm), geometry, speckle, seed);
      },
      py::arg("model"), py::arg("wavelength_nm"), py::arg("geometry"), py::kw_only(), py::arg("speckle") = 0.0,
      py::arg("seed") = 0,
      "Samples that a model would give: each wavelength at all geometries, with Gaussian noise of the speckle law,\n"
      "standard deviation speckle * sqrt(cos theta_i / cos theta_r). The same seed gives the same noise.");
}

}  // namespace

py::object dataset_object(std::vector<Sample> samples, const std::string& reduction) {
  const DatasetPointer data = pointer(std::move(samples));
  data->reduction = reduction;
  return py::cast(data);
}

void bind_dataset(py::module_& m) {
  bind_class(m);
  bind_samples(m);
}

}  // namespace mmbrdf::python
