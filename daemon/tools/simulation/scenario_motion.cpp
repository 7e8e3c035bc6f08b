#include "daemon/tools/simulation/scenario_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>

#include <fmt/core.h>

#include "daemon/tools/simulation/recorded_motion.h"

namespace framewatch::daemon {
namespace {

constexpr double kMaxSamples = 2e7;  // 160 MB, and there are several copies
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
