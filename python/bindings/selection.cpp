// SPDX-License-Identifier: BSD-3-Clause
// Which model the data support, and how far fits to parts of them scatter.
#include "mmbrdf/fitting/selection.hpp"

#include <pybind11/stl.h>

#include "fit.hpp"
#include "mmbrdf/fitting/subsets.hpp"
#include "question.hpp"

namespace mmbrdf::python {

namespace {

using Pair = std::pair<int, int>;
using Reflectances = std::optional<std::map<double, double>>;

std::optional<mmbrdf::Range> range_of(const std::optional<Pair>& ends) {
  return ends ? std::optional(mmbrdf::Range{ends->first, ends->second}) : std::nullopt;
}

py::object held_out(const HeldOut& held_out, const Partition& partition) {
  if (!held_out.undetermined.empty())
    return record("HeldOut", py::none(), py::none(), py::none(), held_out.undetermined);
  return record("HeldOut", held_out.rms, held_out.worst, partition.names[held_out.worst_fold], "");
}

py::tuple candidates(const PartSelection& part, const std::vector<Partition>& partitions) {
  return tuple_of(part.candidates, [&](const Candidate& one) {
    py::dict cross_validation;
    for (std::size_t p = 0; p < partitions.size(); ++p)
      cross_validation[py::str(to_string(partitions[p].kind))] = held_out(one.held_out[p], partitions[p]);
    return record("Candidate", one.order, one.powers, one.coefficients, one.rank, one.condition, one.rms, one.aic,
                  one.bic, cross_validation, one.refusal.empty() ? py::object(py::none()) : py::str(one.refusal));
  });
}

py::object selected(const Dataset& data, const SelectionOptions& options, const FoldOptions& left_out,
                    Weights weights) {
  Folds partitions;
  const Selection found = without_gil([&] {
    partitions = folds(data.samples, left_out);
    return select_model(data.samples, partitions.partitions, options, weights);
  });
  const auto if_any = [&](const auto& value) { return found.orders ? py::cast(value) : py::none(); };
  const Orders orders = found.orders.value_or(Orders{});
  return record("Selection", if_any(Pair(orders.f11, orders.other)), if_any(found.powers),
                candidates(found.f11, partitions.partitions), candidates(found.other, partitions.partitions),
                found.f11.reason, found.other.reason, partitions.note);
}

constexpr const char* select_doc =
    "Which orders and powers of the wavelength the data support, by cross-validation: a Selection.\n\n"
    "orders_f11, orders_other  (first, last); None: (2, 9) and (2, 6), of anisotropic (1, 4) and (1, 3)\n"
    "powers                    (first, last); None: (0, 1), (0, 0) for one wavelength\n"
    "folds, random_folds, seed number of the direction modulo folds, or by lot\n"
    "leave_out                 'angle', 'wavelength', 'angle,wavelength' or 'none'; None: what the data allow\n"
    "Other arguments as those of fit(). Recommended is the lowest order whose error is within 1 % of the smallest;\n"
    "refused is what the data do not determine, and orders above the best whose error is more than 50 % larger.";

void bind_select(py::module_& m) {
  m.def(
      "select",
      [](const Dataset& data, const std::string& family, const std::string& mapping,
         const std::optional<Pair>& orders_f11, const std::optional<Pair>& orders_other,
         const std::optional<Pair>& powers, int folds, bool random, unsigned long seed,
         const std::optional<std::string>& leave_out, const Reflectances& reflectance, const std::string& weights) {
        SelectionOptions options{family_from(family), disc_mapping_from(mapping), range_of(orders_f11),
                                 range_of(orders_other), range_of(powers)};
        if (reflectance) options.reflectance = reflectance_table(*reflectance);
        const LeaveOut what = leave_out ? leave_out_from(*leave_out) : LeaveOut::what_can_be;
        return selected(data, options, {folds, random, seed, what}, weights_from(weights));
      },
      py::arg("data"), py::arg("basis") = "isotropic", py::kw_only(), py::arg("mapping") = "lambert",
      py::arg("orders_f11") = py::none(), py::arg("orders_other") = py::none(), py::arg("powers") = py::none(),
      py::arg("folds") = 3, py::arg("random_folds") = false, py::arg("seed") = 1, py::arg("leave_out") = py::none(),
      py::arg("reflectance") = py::none(), py::arg("weights") = "none", select_doc);
}

py::object split_object(const SubsetSplit& split, const std::vector<double>& theta_r_deg) {
  const SubsetStatistics& s = split.statistics;
  return record("SubsetSplit", split.seed, tuple_of(split.curves, polarized), polarized(s.mean), polarized(s.deviation),
                polarized(split.uncertainty), polarized(split.reference), s.mean_deviation, s.root_mean_variance,
                s.mean_distance, s.largest_distance, theta_r_deg[s.largest_at], s.left_out);
}

/// Those at the wavelength, or all if they have one.
std::vector<Sample> samples_at(const Dataset& data, const std::optional<double>& nm) {
  if (nm) return at_wavelengths(data.samples, std::array{micrometres(*nm)});
  if (const std::vector<double> there = wavelengths(data.samples); there.size() != 1)
    throw std::invalid_argument("wavelength_nm: needed, since the data have samples at " + nanometre_list(there));
  return data.samples;
}

void warn_of_directions(const ModelObject& model, const SubsetQuestion& question) {
  Range range(model);
  range.count(question.wavelength, question.geometries);
  range.warn(question.geometries.size());
}

py::object studied(const Dataset& data, const Division& division, SubsetQuestion question,
                   const std::optional<double>& nm, double theta_i, const Given& theta_r,
                   const ModelObject* reference) {
  const std::vector<Sample> samples = samples_at(data, nm);
  const std::vector<double> theta_r_deg = numbers("theta_r_deg", theta_r);
  std::vector<double> radian;
  for (const double theta : theta_r_deg) radian.push_back(radians(theta));
  question.wavelength = samples.empty() ? 0 : samples.front().wavelength;
  question.geometries = in_plane(radians(theta_i), radian);
  if (reference) question.reference = &reference->model();
  const std::vector<SubsetSplit> splits = without_gil([&] { return split_samples(samples, division, question); });
  Model fitted;
  fitted.name = "the samples";
  fitted.validity = splits.front().validity;
  warn_of_directions(ModelObject(std::move(fitted)), question);
  if (reference) warn_of_directions(*reference, question);
  return record("Subsets", tuple_of(splits, [&](const SubsetSplit& one) { return split_object(one, theta_r_deg); }),
                py::array_t<double>(static_cast<py::ssize_t>(theta_r_deg.size()), theta_r_deg.data()),
                root_mean_variance(splits), splits.front().predicted);
}

constexpr const char* subsets_doc =
    "The subset method of Germer (2017): the samples of one wavelength in k parts that are fitted apart, compared in\n"
    "the plane of incidence, beside what the covariance of the fit to all predicts: Subsets.\n\n"
    "k, random, splits, seed  every k-th sample is of one part; random or splits > 1: by lot, seed, seed + 1, …\n"
    "wavelength_nm            None: that of the samples, if it is one\n"
    "theta_i_deg, theta_r_deg directions of the curves, theta_r_deg > 0 forward; None: -60 to 60 in steps of 1\n"
    "reference                the Model that all is divided by; None: the fit to all samples\n"
    "Other arguments as those of fit().";

void bind_subsets(py::module_& m) {
  m.def(
      "subsets",
      [](const Dataset& data, const std::string& family, Pair orders, int k, bool random, int splits,
         unsigned long seed, const std::optional<double>& nm, double theta_i, const std::optional<Given>& theta_r,
         const std::string& mapping, bool as_printed, const std::string& weights, const ModelObject* reference) {
        SubsetQuestion question;
        question.basis = basis_from(family, orders, mapping, as_printed);
        question.weights = weights_from(weights);
        const py::object usual = py::module_::import("numpy").attr("arange")(-60.0, 61.0);
        return studied(data, {k, splits, random, seed}, std::move(question), nm, theta_i, theta_r.value_or(usual),
                       reference);
      },
      py::arg("data"), py::arg("basis") = "isotropic", py::arg("orders") = Pair(7, 4), py::kw_only(), py::arg("k") = 3,
      py::arg("random") = false, py::arg("splits") = 1, py::arg("seed") = 0, py::arg("wavelength_nm") = py::none(),
      py::arg("theta_i_deg") = 45.0, py::arg("theta_r_deg") = py::none(), py::arg("mapping") = "lambert",
      py::arg("as_printed") = false, py::arg("weights") = "none", py::arg("reference") = py::none(), subsets_doc);
}

}  // namespace

void bind_selection(py::module_& m) {
  bind_select(m);
  bind_subsets(m);
}

}  // namespace mmbrdf::python
