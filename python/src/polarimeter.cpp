// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace mmbrdf::python {
void bind_polarimeter(py::module_&) {}
}  // namespace mmbrdf::python
