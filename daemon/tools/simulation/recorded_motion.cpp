#include "daemon/tools/simulation/recorded_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "drivers/formats/record_file.h"
#include "drivers/records/unit_text.h"

namespace framewatch::daemon {
namespace {

/// Times may be rounded in the file by this share of a step.
constexpr double kUneven = 0.1;

std::optional<std::size_t> chosen_channel(const drivers::Record& record, const std::string& column,
                                          std::string& problem) {
  if (column.empty() && record.names.size() == 1) return 0;
  const auto at = std::find(record.names.begin(), record.names.end(), column);
  if (at != record.names.end()) return static_cast<std::size_t>(at - record.names.begin());
  problem = fmt::format("{}: choose a column of {}",
                        column.empty() ? "it has several channels" : "no channel " + column,
                        fmt::join(record.names, ", "));
  return std::nullopt;
}

std::string problem_of(const drivers::Record& record, const std::vector<double>& accel,
                       double step_s) {
  if (accel.size() < 2) return "a motion needs at least two samples";
  for (std::size_t i = 0; i < accel.size(); ++i) {
    const double due_s = record.time_s.front() + step_s * static_cast<double>(i);
    if (!std::isfinite(accel[i])) return fmt::format("no value at {:g} s", record.time_s[i]);
    if (std::abs(record.time_s[i] - due_s) > kUneven * step_s)
      return fmt::format("its samples are uneven from {:g} s on", record.time_s[i]);
  }
  return "";
}

}  // namespace

estimator::GroundMotion read_recorded_motion(const std::string& path,
                                             const MotionFileFormat& format, std::string& problem) {
  drivers::RecordOptions options;
  options.unit_mps2 = drivers::mps2_per(format.unit);
  if (format.step_s > 0) options.step_s = format.step_s;
  std::vector<drivers::Problem> problems;
  const auto record = drivers::read_record(path, options, problems);
  if (!record) {
    for (const drivers::Problem& p : problems)
      problem += fmt::format("{}{}: {}", problem.empty() ? "" : "; ", p.where, p.message);
    return {};
  }
  const auto channel = chosen_channel(*record, format.column, problem);
  if (!channel) return {};
  estimator::GroundMotion motion;
  motion.accel = record->accel_mps2[*channel];
  if (motion.accel.size() > 1)
    motion.step_s = (record->time_s.back() - record->time_s.front()) /
                    static_cast<double>(motion.accel.size() - 1);
  problem = problem_of(*record, motion.accel, motion.step_s);
  if (!problem.empty()) problem = path + ": " + problem;
  return motion;
}

}  // namespace framewatch::daemon
