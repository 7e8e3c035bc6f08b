// SPDX-License-Identifier: MIT
#include "python/tools.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/file_digest.h"
#include "daemon/base/record_file_arguments.h"
#include "daemon/tools/commands/convert_input.h"
#include "daemon/tools/diagnosis/diagnose_run.h"
#include "daemon/tools/replay/replayed_estimates.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "daemon/tools/simulation/simulation_output.h"
#include "python/arrays.h"
#include "python/building.h"
#include "python/errors.h"
#include "python/estimator.h"
#include "python/interrupts.h"

namespace framewatch::python {
namespace {

namespace py = pybind11;

/// Returns the options of a dict that has every field of RecordFileArguments.
daemon::RecordFileArguments record_arguments(const py::dict& options) {
  daemon::RecordFileArguments out;
  const auto text = [&](const char* key, std::string& to) {
    to = options[key].cast<std::string>();
  };
  text("unit", out.unit);
  text("station_xml", out.station_xml);
  out.step_s = options["step_s"].cast<double>();
  text("format", out.format);
  text("time", out.time);
  text("time_unit", out.time_unit);
  text("zone", out.zone);
  text("decimal", out.decimal);
  out.columns = options["columns"].cast<std::vector<std::string>>();
  out.names = options["names"].cast<std::vector<std::string>>();
  return out;
}

py::dict read_record(const std::vector<std::string>& paths, const std::string& channel,
                     const py::dict& options) {
  const daemon::RecordFileArguments arguments = record_arguments(options);
  std::optional<drivers::Record> record;
  {
    const py::gil_scoped_release release;
    std::vector<drivers::Problem> problems;
    std::vector<std::string> doubts;
    record = daemon::read_to_convert(
        paths, arguments, channel, [&](const std::string& doubt) { doubts.push_back(doubt); },
        problems);
    if (!record || !problems.empty()) refuse(problems);
    record->notes.insert(record->notes.end(), doubts.begin(), doubts.end());
  }
  return dict_of(std::move(*record));
}

py::dict simulate(const std::string& path, const std::string& text, const Building* building,
                  double duration_s, py::object progress) {
  Interrupts interrupts(std::move(progress));
  drivers::Record record;
  {
    const py::gil_scoped_release release;
    std::vector<daemon::ConfigProblem> problems;
    std::optional<daemon::Scenario> scenario = daemon::read_scenario(
        text, path, problems, building != nullptr ? &building->config() : nullptr);
    if (!scenario) refuse(problems);
    if (duration_s > 0) scenario->duration_s = duration_s;
    if (const std::string problem = size_problem(*scenario); !problem.empty())
      throw Error(path + ": " + problem);
    std::vector<std::unique_ptr<daemon::SimulationOutput>> outputs;
    outputs.push_back(record_output(*scenario, record));
    const auto count = static_cast<double>(instants(*scenario));
    const std::string problem = run_simulation(*scenario, path, outputs, [&](std::int64_t done) {
      interrupts("simulate", static_cast<double>(done) / count);
    });
    if (!problem.empty()) throw Error(problem);
  }
  return dict_of(std::move(record));
}

/// inputs: paths and (name, names, units, time_s, accel, rate_hz) of records in memory, in order.
py::tuple replay(const Building& building, const std::vector<std::string>& paths,
                 const py::list& records, bool one_pass, bool salvage, double from_s, double to_s,
                 const py::dict& options, py::object progress) {
  daemon::TuningInput input{paths, record_arguments(options), salvage, {from_s, to_s}, {}};
  for (const py::handle entry : records) {
    const auto r = entry.cast<py::tuple>();
    input.records.push_back(
        {r[0].cast<std::string>(),
         record_of(r[1].cast<std::vector<std::string>>(), r[2].cast<std::vector<std::string>>(),
                   r[3].cast<py::array>(), r[4].cast<py::array>(), r[5].cast<double>())});
  }
  Interrupts interrupts(std::move(progress));
  daemon::ReplayedEstimates out;
  {
    const py::gil_scoped_release release;
    out = replay_estimates(building.config(), input, one_pass,
                           [&](const char* what, double share) { interrupts(what, share); });
    if (!out.problems.empty()) refuse(out.problems);
  }
  return py::make_tuple(
      dict_of(std::move(out.arrays), static_cast<std::size_t>(building.table().size())), out.notes);
}

py::dict diagnose(const Building& building, const std::vector<std::string>& train,
                  const std::vector<std::string>& held_out, const std::vector<std::string>& without,
                  int threads, const std::string& force, bool displacement, bool prescribed,
                  double limit_s, py::object progress) {
  daemon::DiagnoseArguments arguments;
  arguments.component = {force, displacement, prescribed};
  arguments.train = train;
  arguments.holdout = held_out;
  arguments.without = without;
  arguments.threads = threads;
  arguments.limit_s = limit_s;
  Interrupts interrupts(std::move(progress));
  std::string json, text, page;
  run_beside(interrupts, [&](Reports& reports) {
    std::vector<std::string> problems;
    const auto tell = [&](const std::string& what, double share) { reports.tell(what, share); };
    const auto run = daemon::run_diagnosis(building.config(), arguments,
                                           {tell, [&] { reports.check(); }}, problems);
    if (!run) refuse(problems);
    const daemon::DiagnoseOutput output = run->output();
    json = diagnosis_json(output);
    text = diagnosis_text(output);
    page = diagnosis_report(output);
  });
  py::dict out;
  out["json"] = json;
  out["text"] = text;
  out["report_html"] = page;
  return out;
}

}  // namespace

void add_tools(py::module_& module) {
  module.def("read_record", &read_record);
  module.def("simulate", &simulate);
  module.def("replay", &replay);
  module.def("diagnose", &diagnose);
}

}  // namespace framewatch::python
