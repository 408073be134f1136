// SPDX-License-Identifier: BSD-3-Clause
// The one source of the tests in which a path of this machine is compiled: all others are the same in any folder, so that a
// cache of compiled sources knows them again.
#include "given/checkout.hpp"

namespace mmbrdf {

std::string in_checkout(const std::string& file) { return MMBRDF_SOURCE_DIR "/" + file; }

}  // namespace mmbrdf
