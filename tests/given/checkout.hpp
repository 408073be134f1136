// SPDX-License-Identifier: BSD-3-Clause
/// Where the checkout is that a test was built from: files of it are read by tests.
#pragma once

#include <string>

namespace mmbrdf {

/// Path of a file in the checkout, as "docs/formats.md".
std::string in_checkout(const std::string& file);

}  // namespace mmbrdf
