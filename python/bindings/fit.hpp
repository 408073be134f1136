// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mmbrdf/fitting/fit.hpp"

#include <memory>
#include <string>
#include <utility>

#include "dataset.hpp"

namespace mmbrdf::python {

/// A fit as Python holds it, and what was asked for.
struct Fitted : std::enable_shared_from_this<Fitted> {
  Fitted(FitResult its_result, ModelPointer its_model, const Basis& its_basis, Weights its_weights)
      : result(std::move(its_result)), model(std::move(its_model)), basis(its_basis), weights(its_weights) {}
  FitResult result;
  ModelPointer model;
  Basis basis;
  Weights weights;
};
using FittedPointer = std::shared_ptr<Fitted>;

/// Throws std::invalid_argument for names that there are not, and as_printed of another basis than germer2017.
Basis basis_from(const std::string& family, std::pair<int, int> orders, const std::string& mapping, bool as_printed);

}  // namespace mmbrdf::python
