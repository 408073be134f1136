// SPDX-License-Identifier: BSD-3-Clause
// Arrays as numpy keeps them in files: float64 in C order.
#pragma once

#include <cstddef>
#include <istream>
#include <string>
#include <vector>

namespace mmbrdf::program {

/// Whether a file has that name, .npy, or begins as such a file does.
bool is_npy(const std::string& path);
bool begins_as_npy(std::istream& in);

/// Reads up to the numbers. Throws std::runtime_error naming the file for anything but an array of little-endian
/// float64 in C order; returns its shape.
std::vector<std::size_t> read_npy_header(std::istream& in, const std::string& name);

/// The header of an array of this shape; as long for any number of rows, the first of the numbers.
std::string npy_header(const std::vector<std::size_t>& shape);

/// Eight bytes of a file as a number, and the opposite.
double from_npy(const char* bytes);
void to_npy(double value, char* bytes);

}  // namespace mmbrdf::program
