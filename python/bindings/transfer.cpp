// SPDX-License-Identifier: BSD-3-Clause
// Fourier moments of a model in azimuth.

#include <pybind11/stl.h>

#include <cmath>

#include "bindings.hpp"
#include "mmbrdf/model/moments.hpp"
#include "mmbrdf/text/units.hpp"

namespace mmbrdf::python {

namespace {

/// [mu_r, mu_i, m, row, column]
py::array_t<double> array_of_moments(const std::vector<FourierMoments>& all, std::vector<Mueller> FourierMoments::*part,
                                     std::size_t reflected, std::size_t incident, std::size_t count) {
  const auto length = [](std::size_t n) { return static_cast<py::ssize_t>(n); };
  py::array_t<double> result({length(reflected), length(incident), length(count), py::ssize_t{4}, py::ssize_t{4}});
  double* out = result.mutable_data();
  for (const FourierMoments& one : all)
    for (const Mueller& m : one.*part) out = std::copy(m.elements.begin(), m.elements.end(), out);
  return result;
}

/// Of each pair of cosines once, at whatever azimuth.
void warn_of_pairs(const ModelObject& o, double wavelength, const std::vector<double>& incident,
                   const std::vector<double>& reflected) {
  constexpr int step = 10;  // degrees: that of the grid of pairs that samples support
  RangeCount range;
  for (const double mu_r : reflected)
    for (const double mu_i : incident) {
      unsigned where = inside;
      for (int phi = 0; phi <= 180; phi += step)
        where |= outside(o.model().validity, wavelength, {{std::acos(mu_i), 0}, {std::acos(mu_r), radians(phi)}});
      range.add(static_cast<Outside>(where));
    }
  warn_outside(o, range);
}

py::object moments_of(const ModelObject& o, const std::optional<double>& wavelength_nm, const Given& mu_i,
                      const Given& mu_r) {
  const std::vector<double> incident = numbers("mu_i", mu_i), reflected = numbers("mu_r", mu_r);
  const double wavelength = o.wavelength(wavelength_nm);
  const PreparedModel model = o.prepared(wavelength, false);
  const std::size_t count = static_cast<std::size_t>(highest_moment(model)) + 1;
  const auto all = without_gil([&] { return fourier_moments(model, incident, reflected); });
  warn_of_pairs(o, wavelength, incident, reflected);
  const auto part = [&](std::vector<Mueller> FourierMoments::*which) {
    return array_of_moments(all, which, reflected.size(), incident.size(), count);
  };
  return record("FourierMoments", part(&FourierMoments::cosine), part(&FourierMoments::sine));
}

}  // namespace

void bind_transfer(ModelClass& model) {
  model.def(
      "fourier_moments", moments_of, py::arg("wavelength_nm"), py::arg("mu_i"), py::arg("mu_r"),
      "FourierMoments(cosine, sine): arrays [mu_r, mu_i, m, row, column] in sr^-1, frame sp, of all m that are not "
      "0:\n"
      "M = sum of cosine[..., m, :, :] cos(m phi) + sine[..., m, :, :] sin(m phi), phi = phi_r - phi_i, weight 1 "
      "for each m.\n"
      "mu_i, mu_r: cosines of the polar angles of source and detector, a number or a list of them. In closed form "
      "from the\n"
      "modes, to 1e-12 of f11. nan in elements that the model does not know. Warns (ExtrapolationWarning) once of "
      "pairs "
      "of\n"
      "cosines that leave the fitted range at any azimuth. Raises ValueError for a model that depends on the azimuth "
      "of "
      "the\n"
      "source (anisotropic, as printed), and for a cosine that is not in 0 ... 1.");
  model.def(
      "_is_its_own_mirror_image", [](const ModelObject& o) { return is_its_own_mirror_image(prepare(o.model(), 1)); },
      "Whether elements with one index in {1, 2} and one in {3, 4} have sines of phi_r - phi_i alone, all others "
      "cosines.");
}

}  // namespace mmbrdf::python
