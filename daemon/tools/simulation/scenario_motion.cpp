// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/scenario_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "drivers/formats/record_file.h"
#include "drivers/records/unit_text.h"

namespace framewatch::daemon {
namespace {

/// Largest rounding of times in the file, as a share of a step.
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

constexpr double kMaxSamples = 2e7;  // 160 MB per copy, of which there are several
constexpr std::initializer_list<const char*> kSeededKeys = {"ground_frequency_hz",
                                                            "ground_damping_ratio",
                                                            "high_pass_hz",
                                                            "build_up_s",
                                                            "strong_s",
                                                            "decay_s",
                                                            "length_s"};
constexpr std::initializer_list<const char*> kRecordKeys = {"unit", "step_s", "column", "scale"};

void refuse(ConfigSection& s, std::initializer_list<const char*> keys, const char* why) {
  for (const char* key : keys)
    if (s.given(key)) s.problem(key, why);
}

estimator::GroundMotion seeded(ConfigSection& s, std::uint64_t seed) {
  refuse(s, kRecordKeys, "is for a recorded motion, and no file is given");
  estimator::KanaiTajimi p;
  p.ground_frequency_hz = s.number("ground_frequency_hz");
  p.ground_damping_ratio = s.number("ground_damping_ratio");
  p.high_pass_hz = s.number("high_pass_hz");
  if (s.given("peak_mps2")) p.peak_mps2 = s.number("peak_mps2");
  p.duration_s = s.number("length_s");
  p.build_up_s = s.number("build_up_s");
  p.strong_s = s.number("strong_s");
  p.decay_s = s.number("decay_s");
  p.seed = seed;
  return kanai_tajimi(p);
}

estimator::GroundMotion recorded(ConfigSection& s, const std::string& directory) {
  refuse(s, kSeededKeys, "is for a Kanai-Tajimi motion, and a file is given");
  const std::filesystem::path path = std::filesystem::path(directory) / s.text("file");
  std::string problem;
  estimator::GroundMotion motion = read_recorded_motion(
      path.string(),
      {s.given("unit") ? s.text("unit") : "", s.given("step_s") ? s.number("step_s") : 0,
       s.given("column") ? s.text("column") : ""},
      problem);
  if (!problem.empty()) {
    s.problem("file", problem);
    return {};
  }
  double factor = s.number("scale");
  if (s.given("peak_mps2")) {
    if (s.given("scale")) s.problem("peak_mps2", "only one of scale and peak_mps2 may be given");
    if (motion.peak() > 0) factor = s.number("peak_mps2") / motion.peak();
  }
  for (double& a : motion.accel) a *= factor;
  return motion;
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

estimator::PlanMotion read_motion(ConfigSection& s, const std::string& directory,
                                  std::uint64_t seed) {
  if (!s.good("length_s") || !s.good("start_s")) return {};
  estimator::GroundMotion motion = s.given("file") ? recorded(s, directory) : seeded(s, seed);
  if (motion.accel.empty()) return {};
  const double rest_samples = s.number("start_s") / motion.step_s;
  if (!(rest_samples + static_cast<double>(motion.accel.size()) <= kMaxSamples)) {
    s.problem("start_s",
              fmt::format("{:g} s of rest are {:.3g} samples of this motion, a {:g} s: "
                          "it may have {:.0f} with them",
                          s.number("start_s"), rest_samples, motion.step_s, kMaxSamples));
    return {};
  }
  const auto rest = static_cast<std::size_t>(std::llround(rest_samples));
  motion.accel.insert(motion.accel.begin(), rest, 0.0);
  return directed(motion, s.number("angle_deg") * M_PI / 180);
}

}  // namespace framewatch::daemon
