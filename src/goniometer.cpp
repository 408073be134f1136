// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/goniometer.hpp"
