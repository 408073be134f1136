// SPDX-License-Identifier: BSD-3-Clause
// What a measurement will tell.
#include "mmbrdf/quantities/plan_like.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>

#include "bindings.hpp"
#include "mmbrdf/model/description.hpp"

namespace mmbrdf::python {

namespace {

using Texts = std::vector<std::string>;
using Four = std::array<Given, 4>;

/// Four arrays that broadcast.
std::vector<Geometry> geometries_of(const std::string& what, const py::handle& angles) {
  Four four;
  try {
    four = angles.cast<Four>();
  } catch (const py::cast_error&) {
    throw std::invalid_argument(what + ": expected (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)");
  }
  return geometries(Broadcast(direction_operands(four[0], four[1], four[2], four[3])));
}

VarianceComponents components(const ModelObject* like, const std::optional<double>& nm,
                              const std::optional<double>& noise) {
  const std::optional<double> wavelength = nm ? std::optional(micrometres(*nm)) : std::nullopt;
  if (!like) return components_like(nullptr, wavelength, noise);
  try {
    return components_like(&like->model(), wavelength, noise);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("like: ") + error.what());
  }
}

std::vector<NamedTarget> targets_of(const Texts& texts) {
  std::vector<NamedTarget> result;
  for (const std::string& text : texts)
    for (NamedTarget& one : targets_from(text)) result.push_back(std::move(one));
  return result;
}

std::vector<PlanTarget> without_names(const std::vector<NamedTarget>& named) {
  std::vector<PlanTarget> result;
  for (const NamedTarget& one : named) result.push_back(one.target);
  return result;
}

py::object planned(const py::dict& given, const ModelObject* like, const std::optional<double>& nm,
                   const std::optional<double>& noise, const Texts& texts) {
  if (given.empty()) throw std::invalid_argument("designs: none given");
  std::vector<NamedDesign> designs;
  for (const auto& [name, angles] : given)
    for (NamedDesign& one : with_turns({name.cast<std::string>(), geometries_of("designs", angles)}))
      designs.push_back(std::move(one));
  const VarianceComponents known = components(like, nm, noise);
  std::vector<NamedTarget> targets = block_targets(known);
  for (NamedTarget& one : targets_of(texts)) targets.push_back(std::move(one));
  py::array_t<double> u({designs.size(), targets.size()});
  double* out = u.mutable_data();
  without_gil([&] {
    for (const NamedDesign& design : designs)
      out = std::ranges::copy(expected_uncertainties(known, design.geometries, without_names(targets)), out).out;
  });
  return record("Plan", tuple_of(designs, [](const NamedDesign& one) { return one.name; }),
                tuple_of(designs, [](const NamedDesign& one) { return one.geometries.size(); }),
                tuple_of(targets, [](const NamedTarget& one) { return one.name; }), u);
}

std::vector<std::size_t> picks(std::size_t count, const py::object& candidates, const py::object& design,
                               const ModelObject* like, const std::optional<double>& nm,
                               const std::optional<double>& noise, const Texts& texts) {
  const std::vector<Geometry> choice = geometries_of("candidates", candidates);
  const std::vector<Geometry> start = design.is_none() ? std::vector<Geometry>{} : geometries_of("design", design);
  const VarianceComponents known = components(like, nm, noise);
  const std::vector<PlanTarget> targets = without_names(texts.empty() ? block_targets(known) : targets_of(texts));
  return without_gil([&] { return chosen(known, start, targets, choice, count); });
}

constexpr const char* plan_doc =
    "Expected standard uncertainties (k = 1) of a measurement before it is made, at one wavelength: a Plan. Errors "
    "that\n"
    "all readings share are not in them.\n\n"
    "designs        {name: (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg)}, arrays that broadcast; each is shown as "
    "it\n"
    "               is and with the sample turned between its readings\n"
    "like           a fitted Model whose sample's variances and noise count; None: those of sintered PTFE\n"
    "wavelength_nm  of that fit; None: its first\n"
    "noise          of a reading, at normal directions, relative for f11; None: of the fit, 0.007 without one\n"
    "targets        beside the blocks: 'dhr:THETA[,THETA...]', 'f:THETA_I:THETA_R[:PHI_R]', in degrees";

constexpr const char* choose_doc =
    "The `count` candidates to measure next, as indices into them in C order, one after the other each that which\n"
    "lowers the variances of the targets most; a candidate may come again.\n\n"
    "candidates, design  (theta_i_deg, phi_i_deg, theta_r_deg, phi_r_deg); design: what is measured already\n"
    "targets             as for plan(); none: all blocks\n"
    "Other arguments as those of plan().";

}  // namespace

void bind_plan(py::module_& m) {
  m.def("plan", planned, py::arg("designs"), py::kw_only(), py::arg("like") = py::none(),
        py::arg("wavelength_nm") = py::none(), py::arg("noise") = py::none(), py::arg("targets") = Texts{}, plan_doc);
  m.def(
      "choose",
      [](std::size_t count, const py::object& candidates, const py::object& design, const ModelObject* like,
         const std::optional<double>& nm, const std::optional<double>& noise, const Texts& targets) {
        const std::vector<std::size_t> list = picks(count, candidates, design, like, nm, noise, targets);
        return py::array_t<std::int64_t>(py::cast(list));
      },
      py::arg("count"), py::arg("candidates"), py::kw_only(), py::arg("design") = py::none(),
      py::arg("like") = py::none(), py::arg("wavelength_nm") = py::none(), py::arg("noise") = py::none(),
      py::arg("targets") = Texts{}, choose_doc);
}

}  // namespace mmbrdf::python
