// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/floors_output.h"

#include <cmath>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {

FloorsOutput::FloorsOutput(const estimator::PipelineConfig& config)
    : structure_(config.structure), response_(config) {}

bool FloorsOutput::good(bool done) {
  if (!done && error_.empty()) error_ = fmt::format("{}: {}", path_, file_.error());
  return done;
}

bool FloorsOutput::open(const std::string& path) {
  path_ = path;
  std::string header = "time_s";
  for (int floor = 0; floor <= structure_.stories; ++floor)
    for (int f = 0; f < structure_.frames(); ++f)
      header += fmt::format(",accel_{}_{}_mps2", floor, structure_.frame_name(f));
  for (int story = 1; story <= structure_.stories; ++story)
    for (int f = 0; f < structure_.frames(); ++f)
      header += fmt::format(",drift_{}_{}_ratio", story, structure_.frame_name(f));
  return good(file_.open(path)) && good(file_.write(header + "\n"));
}

bool FloorsOutput::put(const estimator::SampleSet& instant) {
  response_.push(instant);
  line_ = drivers::format_number(1e-6 * static_cast<double>(to_microseconds(instant.time)));
  const auto cell = [&](double value) {
    line_ += ',';
    if (std::isfinite(value)) line_ += fmt::format("{:.6g}", value);
  };
  for (int floor = 0; floor <= structure_.stories; ++floor)
    for (int f = 0; f < structure_.frames(); ++f) cell(response_.floor_accel_mps2(floor, f));
  for (int story = 1; story <= structure_.stories; ++story)
    for (int f = 0; f < structure_.frames(); ++f)
      cell(response_.drift_m()[static_cast<std::size_t>(structure_.dof(story, f))] /
           structure_.story_height[static_cast<std::size_t>(story - 1)]);
  line_ += '\n';
  return good(file_.write(line_));
}

bool FloorsOutput::close() {
  return good(file_.close());
}

}  // namespace framewatch::daemon
