// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mmbrdf/fitting/fit.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dataset.hpp"
#include "instrument.hpp"

namespace mmbrdf::python {

/// A fit as Python holds it, and what was asked for.
struct Fitted : std::enable_shared_from_this<Fitted> {
  /// `known_warnings` are those of samples that are no longer there.
  Fitted(FitResult its_result, ModelPointer its_model, const Basis& its_basis, Weights its_weights,
         std::vector<std::string> known_warnings = {})
      : result(std::move(its_result)),
        model(std::move(its_model)),
        basis(its_basis),
        weights(its_weights),
        warnings_(std::move(known_warnings)) {}
  FitResult result;
  ModelPointer model;
  Basis basis;
  Weights weights;
  std::vector<Sample> some;   ///< of the first wavelength, most_tried at most, evenly spread
  std::vector<long> numbers;  ///< theirs, from 1

  /// fit_warnings(), found when they are first asked for.
  const std::vector<std::string>& warnings();

 private:
  std::once_flag asked_;
  std::vector<std::string> warnings_;
};
using FittedPointer = std::shared_ptr<Fitted>;

struct Request {
  Basis basis;
  FitOptions options;
  Weights weights = Weights::none;
  InstrumentPointer instrument;
  std::string name, attribution;
};

/// As Python holds it, with a model that says from what and how it was made.
FittedPointer signed_result(FitResult result, const Request& request, std::size_t rows, const Dataset* data = nullptr);

/// Of names in degrees. Throws ValueError for a name that there is not, and for what is negative.
DeclaredErrors declared_from(const std::map<std::string, double>& named);

/// Of a name; nothing: speckle where the uncertainty is that of an isotropic sample, else none.
Weights weights_or_default(const std::optional<std::string>& name, const Basis& basis, Uncertainty uncertainty);

/// Throws std::invalid_argument for names that there are not, and as_printed of another basis than germer2017.
Basis basis_from(const std::string& family, std::pair<int, int> orders, const std::string& mapping, bool as_printed);

}  // namespace mmbrdf::python
