// SPDX-License-Identifier: BSD-3-Clause
// Fits of samples that come in parts.
#include <pybind11/stl.h>

#include <map>
#include <mutex>
#include <utility>

#include "fit.hpp"
#include "mmbrdf/fitting/sample_fit.hpp"

namespace mmbrdf::python {

namespace {

using Reflectances = std::optional<std::map<double, double>>;

py::array_t<double> array_of_numbers(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

Request request_of(const Basis& basis, Weights weights, std::optional<int> powers, const Reflectances& reflectance,
                   bool minimum_norm, const std::string& name, const std::string& attribution) {
  Request request{basis, {}, weights, nullptr, name, attribution};
  request.options.powers = powers;
  request.options.minimum_norm = minimum_norm;
  if (reflectance) request.options.reflectance = reflectance_table(*reflectance);
  return request;
}

/// The arguments from which a basis is made again.
py::tuple arguments_of(const Basis& basis) {
  return py::make_tuple(to_string(basis.family), std::pair(basis.orders.f11, basis.orders.other),
                        to_string(basis.mapping), basis.rotation == Rotation::as_printed);
}
Basis basis_of(const py::tuple& t) {
  return basis_from(t[0].cast<std::string>(), t[1].cast<std::pair<int, int>>(), t[2].cast<std::string>(),
                    t[3].cast<bool>());
}

// ---- of the noise ----

/// A FitAccumulator, and what it was made of. It changes: all of it happens under the interpreter's lock.
struct Accumulator {
  Basis basis;
  FitAccumulator fit{basis};

  FittedPointer solve(std::optional<int> powers, const Reflectances& reflectance, bool minimum_norm,
                      const std::string& name, const std::string& attribution) const {
    const Request request = request_of(basis, Weights::none, powers, reflectance, minimum_norm, name, attribution);
    return signed_result(fit.solve(request.options), request, static_cast<std::size_t>(fit.samples()));
  }
  py::array_t<double> state() const { return array_of_numbers(fit.state()); }
};

Accumulator from_state(const Basis& basis, const Given& state) {
  return {basis, FitAccumulator::from_state(basis, numbers("state", state))};
}

py::tuple pickled_accumulator(const Accumulator& a) { return py::make_tuple(arguments_of(a.basis), a.state()); }

Accumulator unpickled_accumulator(const py::tuple& t) {
  return from_state(basis_of(t[0].cast<py::tuple>()), t[1].cast<Given>());
}

void bind_accumulator(py::module_& m) {
  py::class_<Accumulator>(m, "FitAccumulator",
                          "A fit that samples are added to in any order and number, and in any number of processes:\n"
                          "memory does not grow with the samples. To send it, pickle it; to save its numbers, state().")
      .def(py::init([](const std::string& family, std::pair<int, int> orders, const std::string& mapping,
                       bool as_printed) { return Accumulator{basis_from(family, orders, mapping, as_printed)}; }),
           py::arg("basis") = "isotropic", py::arg("orders") = std::pair(7, 4), py::kw_only(),
           py::arg("mapping") = "lambert", py::arg("as_printed") = false)
      .def(
          "add", [](Accumulator& a, const Dataset& data) { a.fit.add(data.samples); }, py::arg("data"))
      .def(
          "merge", [](Accumulator& a, const Accumulator& other) { a.fit.merge(other.fit); }, py::arg("other"),
          "As if all samples of the other, which has the same basis, had been added here.")
      .def("solve", &Accumulator::solve, py::kw_only(), py::arg("powers") = py::none(),
           py::arg("reflectance") = py::none(), py::arg("minimum_norm") = false, py::arg("name") = "",
           py::arg("attribution") = "", "FitResult of all samples so far, as fit() without weights, but for residuals.")
      .def_property_readonly("samples", [](const Accumulator& a) { return a.fit.samples(); })
      .def("state", &Accumulator::state, "Everything there is but for the basis: an array of numbers.")
      .def_static(
          "from_state",
          [](const Given& state, const std::string& family, std::pair<int, int> orders, const std::string& mapping,
             bool as_printed) { return from_state(basis_from(family, orders, mapping, as_printed), state); },
          py::arg("state"), py::arg("basis") = "isotropic", py::arg("orders") = std::pair(7, 4), py::kw_only(),
          py::arg("mapping") = "lambert", py::arg("as_printed") = false)
      .def(py::pickle(&pickled_accumulator, &unpickled_accumulator));
}

// ---- of the sample ----

/// A SampleFitAccumulator, and what it was made of. A round takes long: others may use the interpreter meanwhile, but
/// not this.
class SampleSums {
  auto alone(const auto& work) {
    return without_gil([&] {
      const std::scoped_lock lock(guard_);
      return work();
    });
  }

 public:
  SampleSums(const Basis& basis, Weights weights, SampleFitAccumulator sums)
      : basis_(basis), weights_(weights), sums_(std::move(sums)) {}

  void add(const Dataset& data, int threads) {
    if (threads < 0 || threads > most_threads)
      throw py::value_error("threads = " + std::to_string(threads) + ", must be from 0 to " +
                            std::to_string(most_threads));
    alone([&] { sums_.add(data.samples, threads); });
  }
  void merge(SampleSums& other) {
    const SampleFitAccumulator theirs = other.alone([&] { return other.sums_; });
    alone([&] { sums_.merge(theirs); });
  }
  std::unique_ptr<SampleSums> copied() {
    return std::make_unique<SampleSums>(basis_, weights_, alone([&] { return sums_; }));
  }
  bool next_round() {
    return alone([&] { return sums_.next_round(); });
  }
  FittedPointer solve(std::optional<int> powers, const Reflectances& reflectance,
                      const std::map<std::string, double>& declared, bool minimum_norm, const std::string& name,
                      const std::string& attribution) {
    Request request = request_of(basis_, weights_, powers, reflectance, minimum_norm, name, attribution);
    request.options.declared = declared_from(declared);
    return alone([&] {
      return signed_result(sums_.solve(request.options), request, static_cast<std::size_t>(sums_.samples()));
    });
  }
  int round() {
    return alone([&] { return sums_.round(); });
  }
  bool finished() {
    return alone([&] { return sums_.finished(); });
  }
  long samples() {
    return alone([&] { return sums_.samples(); });
  }
  py::array_t<double> state() {
    return array_of_numbers(alone([&] { return sums_.state(); }));
  }
  py::tuple pickled() { return py::make_tuple(arguments_of(basis_), to_string(weights_), state()); }

 private:
  Basis basis_;
  Weights weights_;
  SampleFitAccumulator sums_;
  std::mutex guard_;
};

using SampleSumsPointer = std::unique_ptr<SampleSums>;

SampleSumsPointer sums_from_state(const Basis& basis, Weights weights, const Given& state) {
  return std::make_unique<SampleSums>(basis, weights,
                                      SampleFitAccumulator::from_state(basis, weights, numbers("state", state)));
}

constexpr const char* sample_doc =
    "A fit of a real sample, as fit() gives by default, of samples that are not in memory together: memory does not "
    "grow\nwith their number. It goes over all of them in rounds, as later sums are weighed by what earlier ones "
    "found:\n\n"
    "    sums = mmbrdf.SampleFitAccumulator()\n"
    "    more = True\n"
    "    while more:\n"
    "        for path in paths:                      # the same samples in each round, in any order and parts\n"
    "            sums.add(mmbrdf.read_samples(path))\n"
    "        more = sums.next_round()\n"
    "    result = sums.solve()\n\n"
    "In many processes each adds its part of a round to a copy, and copies are merged; mmbrdf.distributed.fit does "
    "that.\nweights: 'none' or 'speckle'; None: 'speckle' with the isotropic basis, else 'none'. Where there is no "
    "mixed model it is\na fit of the noise, and FitResult.warnings says why. To send it, pickle it; to save its "
    "numbers, state().";

void bind_sample_accumulator(py::module_& m) {
  const auto made = [](const std::string& family, std::pair<int, int> orders, const std::string& mapping,
                       bool as_printed, const std::optional<std::string>& name) {
    const Basis basis = basis_from(family, orders, mapping, as_printed);
    const Weights weights = weights_or_default(name, basis, Uncertainty::sample);
    return std::make_unique<SampleSums>(basis, weights, SampleFitAccumulator(basis, weights));
  };
  py::class_<SampleSums>(m, "SampleFitAccumulator", sample_doc)
      .def(py::init(made), py::arg("basis") = "isotropic", py::arg("orders") = std::pair(7, 4), py::kw_only(),
           py::arg("mapping") = "lambert", py::arg("as_printed") = false, py::arg("weights") = py::none())
      .def("add", &SampleSums::add, py::arg("data"), py::kw_only(), py::arg("threads") = 0,
           "To the sums of this round. threads 0: one for each core.")
      .def("merge", &SampleSums::merge, py::arg("other"),
           "As if what was added to the other in this round had been added here.")
      .def("next_round", &SampleSums::next_round,
           "Ends the round. True: add all samples again; False: solve() may be called. ValueError for other samples "
           "than in\nthe first round.")
      .def("solve", &SampleSums::solve, py::kw_only(), py::arg("powers") = py::none(),
           py::arg("reflectance") = py::none(), py::arg("declared") = std::map<std::string, double>{},
           py::arg("minimum_norm") = false, py::arg("name") = "", py::arg("attribution") = "",
           "FitResult of all samples, as fit() gives, but for residuals.")
      .def_property_readonly("round", &SampleSums::round, "1 to 4")
      .def_property_readonly("finished", &SampleSums::finished, "Whether next_round() has said False")
      .def_property_readonly("samples", &SampleSums::samples, "Of this round so far")
      .def("__copy__", &SampleSums::copied)
      .def("__deepcopy__", [](SampleSums& sums, const py::dict&) { return sums.copied(); })
      .def("state", &SampleSums::state, "Everything there is but for basis and weights: an array of numbers.")
      .def_static(
          "from_state",
          [](const Given& state, const std::string& family, std::pair<int, int> orders, const std::string& mapping,
             bool as_printed, const std::optional<std::string>& name) {
            const Basis basis = basis_from(family, orders, mapping, as_printed);
            return sums_from_state(basis, weights_or_default(name, basis, Uncertainty::sample), state);
          },
          py::arg("state"), py::arg("basis") = "isotropic", py::arg("orders") = std::pair(7, 4), py::kw_only(),
          py::arg("mapping") = "lambert", py::arg("as_printed") = false, py::arg("weights") = py::none())
      .def(py::pickle([](SampleSums& sums) { return sums.pickled(); },
                      [](const py::tuple& t) {
                        return sums_from_state(basis_of(t[0].cast<py::tuple>()), weights_from(t[1].cast<std::string>()),
                                               t[2].cast<Given>());
                      }));
}

}  // namespace

void bind_accumulators(py::module_& m) {
  bind_accumulator(m);
  bind_sample_accumulator(m);
}

}  // namespace mmbrdf::python
