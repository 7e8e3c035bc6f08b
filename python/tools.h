// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>  // in every source, so that all convert alike

namespace framewatch::python {

/// Adds read_record(), simulate(), replay() and diagnose() to the module.
void add_tools(pybind11::module_& module);

}  // namespace framewatch::python
