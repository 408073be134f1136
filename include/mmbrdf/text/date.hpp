// SPDX-License-Identifier: BSD-3-Clause
/// When something is made.
#pragma once

#include <string>

namespace mmbrdf {

/// Now, or at SOURCE_DATE_EPOCH, as those who build reproducibly set it; in UTC: "2026-11-30T00:20:00+00:00". Throws
/// std::invalid_argument for a SOURCE_DATE_EPOCH that is not whole seconds since 1970.
std::string utc_timestamp();

}  // namespace mmbrdf
