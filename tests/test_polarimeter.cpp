// SPDX-License-Identifier: BSD-3-Clause
#include "mmbrdf/polarimeter.hpp"

#include <gtest/gtest.h>
