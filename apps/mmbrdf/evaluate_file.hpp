// SPDX-License-Identifier: BSD-3-Clause
// Evaluates a model at each row of a CSV file of any length.
#pragma once

#include <string>

#include "mmbrdf/geometry.hpp"
#include "mmbrdf/model.hpp"

namespace mmbrdf::program {

struct FileEvaluation {
  std::string model;      ///< name, for messages
  std::string input;      ///< path; - for standard input
  std::string output;     ///< path; empty or - for standard output
  double wavelength = 0;  ///< micrometres, for rows without; 0: the model's own
  Frame frame = Frame::xy;
  Rotation rotation = Rotation::covariant;
  bool normalized = false;
};

/// Each row as it is, with the 16 elements and the validity behind it. A column of the input that has the name of one
/// of those is called input_NAME. Says on standard error how many rows lie outside the fitted range, if that is known.
/// Throws std::runtime_error naming file and line.
void evaluate_file(const Model& model, const FileEvaluation& what);

}  // namespace mmbrdf::program
