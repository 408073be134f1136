// SPDX-License-Identifier: BSD-3-Clause
// XML of windows' layers with the 145 directions of Klems' full basis, as Radiance reads it.
#pragma once

#include "mmbrdf/formats/export.hpp"

namespace mmbrdf {

Export::Made make_klems(const Model& model, const ExportOptions& options);

}  // namespace mmbrdf
