// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/elements.hpp"

#include <gtest/gtest.h>
