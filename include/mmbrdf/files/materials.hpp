// SPDX-License-Identifier: BSD-3-Clause
/// Models that are part of the library.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mmbrdf/model/model.hpp"

namespace mmbrdf {

/// Names of the built-in models, by wavelength: ptfe (351–1064 nm), ptfe-351, ptfe-532, ptfe-633, ptfe-1064.
/// Their provenance says from which data and with which command each was made.
std::vector<std::string> materials();

/// A built-in model. Throws std::invalid_argument, with the names there are, for another name.
Model material(std::string_view name);

}  // namespace mmbrdf
