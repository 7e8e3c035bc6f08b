// SPDX-License-Identifier: MIT
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/file_digest.h"
#include "python/arrays.h"
#include "python/building.h"
#include "python/errors.h"
#include "python/estimator.h"
#include "python/tools.h"

namespace framewatch::python {
namespace {

namespace py = pybind11;

/// Refuses every interpreter of the process but the first one that calls it: the types of this
/// module would be shared between them. Throws ImportError.
void claim_interpreter() {
  static const std::int64_t first = PyInterpreterState_GetID(PyInterpreterState_Get());
  const std::int64_t own = PyInterpreterState_GetID(PyInterpreterState_Get());
  if (own != first)
    throw py::import_error(
        "framewatch is already used by another interpreter of this process; import it in one "
        "interpreter, or use processes");
}

std::string read_text(const std::string& path) {
  std::string error;
  const std::optional<std::string> text = daemon::read_text_file(path, error);
  if (!text) throw Error(path + ": " + error);
  return *text;
}

template <typename Of>
std::vector<std::string> of_parameters(const Building& b, const Of& of) {
  std::vector<std::string> out;
  for (int p = 0; p < b.table().size(); ++p) out.push_back(of(b.table()[p]));
  return out;
}

std::vector<std::string> channels_of(const Building& b) {
  std::vector<std::string> out;
  for (const estimator::SensorAxis& axis : b.config().pipeline.axes) out.push_back(axis.name);
  return out;
}

py::object design_of(const Building& b) {
  const Eigen::VectorXd& design = b.config().pipeline.design;
  if (design.size() == 0) return py::none();
  return owned(std::vector<double>(design.begin(), design.end()));
}

void add_building(py::module_& module) {
  py::class_<Building>(module, "Building")
      .def(py::init<std::string, std::string>())
      .def_property_readonly("path", &Building::path)
      .def_property_readonly("text", &Building::text)
      .def_property_readonly("name",
                             [](const Building& b) { return b.config().pipeline.structure.name; })
      .def_property_readonly(
          "stories", [](const Building& b) { return b.config().pipeline.structure.stories; })
      .def_property_readonly("channels", &channels_of)
      .def_property_readonly("parameters",
                             [](const Building& b) {
                               return of_parameters(
                                   b, [](const estimator::Parameter& p) { return p.name; });
                             })
      .def_property_readonly("units",
                             [](const Building& b) {
                               return of_parameters(
                                   b, [](const estimator::Parameter& p) { return p.unit; });
                             })
      .def_property_readonly("design", &design_of)
      .def_property_readonly("rate_hz",
                             [](const Building& b) { return b.config().pipeline.options.rate_hz; })
      .def_property_readonly("window_s",
                             [](const Building& b) { return b.config().pipeline.options.window_s; })
      .def_property_readonly("sha256", [](const Building& b) { return b.config().sha256; })
      .def_property_readonly("doubts",
                             [](const Building& b) { return lines_of(b.config().doubts); })
      .def(py::pickle([](const Building& b) { return py::make_tuple(b.path(), b.text()); },
                      [](const py::tuple& state) {
                        return Building(state[0].cast<std::string>(), state[1].cast<std::string>());
                      }));
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  claim_interpreter();
  module.def("claim_interpreter", &claim_interpreter);
  py::register_exception<Error>(module, "Error", PyExc_ValueError);
  module.attr("version") = FRAMEWATCH_VERSION;
  module.def("read_text", &read_text);
  add_building(module);
  py::class_<Estimator>(module, "Estimator")
      .def(py::init<const Building&>())
      .def("push", &Estimator::push)
      .def("finish", &Estimator::finish)
      .def_property_readonly("newest_us", &Estimator::newest_us);
  add_tools(module);
}

}  // namespace framewatch::python
