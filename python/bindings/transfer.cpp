// SPDX-License-Identifier: BSD-3-Clause
// Fourier moments of a model in azimuth.

#include <pybind11/stl.h>

#include "bindings.hpp"
#include "mmbrdf/model/moments.hpp"

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

py::object moments_of(const ModelObject& o, const std::optional<double>& wavelength_nm, const Given& mu_i,
                      const Given& mu_r) {
  const std::vector<double> incident = numbers("mu_i", mu_i), reflected = numbers("mu_r", mu_r);
  const PreparedModel model = o.prepared(o.wavelength(wavelength_nm), false);
  const std::size_t count = static_cast<std::size_t>(highest_moment(model)) + 1;
  const auto all = without_gil([&] { return fourier_moments(model, incident, reflected); });
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
      "modes, to 1e-12 of f11. nan in elements that the model does not know. Raises ValueError for a model that "
      "depends on the\n"
      "azimuth of the source (anisotropic, as printed), and for a cosine that is not in 0 ... 1.");
}

}  // namespace mmbrdf::python
