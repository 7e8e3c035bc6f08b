// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replay_survey.h"
#include "daemon/tools/replay/stored_samples.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/motion/acquisition.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kMaxValues = 1LL << 26;

/// Collects sample sets by their place on the common grid.
class Collector {
 public:
  explicit Collector(const estimator::PipelineConfig& config)
      : acquisition_(config.axes, config.options) {}

  void push(const estimator::AccelSample& sample) { keep(acquisition_.push(sample)); }
  void finish() { keep(acquisition_.finish()); }
  bool too_long() const { return too_long_; }
  const std::vector<estimator::SensorAxis>& axes() const { return acquisition_.axes(); }
  std::int64_t first_us() const { return first_us_; }
  Eigen::MatrixXd accel() const {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto count = static_cast<Eigen::Index>(axes().size());
    return Eigen::Map<const RowMajor>(kept_.data(), static_cast<Eigen::Index>(kept_.size()) / count,
                                      count);
  }

 private:
  void keep(estimator::Acquisition::SampleSets&& sets) {
    for (const estimator::SampleSet& set : sets) keep(set);
  }
  void keep(const estimator::SampleSet& set) {
    if (first_index_ < 0) {
      first_index_ = set.index;
      first_us_ = to_microseconds(set.time);
    }
    const std::int64_t row = set.index - first_index_;
    const auto count = static_cast<std::int64_t>(axes().size());
    too_long_ = too_long_ || row < 0 || (row + 1) * count > kMaxValues;
    if (too_long_) return;
    const auto at = static_cast<std::size_t>(row * count);
    if (kept_.size() < at + set.accel.size()) kept_.resize(at + set.accel.size(), estimator::kNaN);
    std::copy(set.accel.begin(), set.accel.end(), kept_.begin() + static_cast<std::ptrdiff_t>(at));
  }

  std::int64_t first_index_ = -1, first_us_ = 0;
  std::vector<double> kept_;
  bool too_long_ = false;
  estimator::Acquisition acquisition_;
};

/// Returns true for axes of the base and forces: those that make the building move.
bool drives(const estimator::SensorAxis& axis) {
  return axis.story == 0 || axis.is_force;
}

/// Returns for each block the largest rms, without the block's mean, of the axes that drive the
/// building, or of the others.
std::vector<double> block_rms(const SessionMotion& m, bool driving, Eigen::Index block) {
  std::vector<double> out(static_cast<std::size_t>(m.accel.rows() / block), 0.0);
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (drives(m.axes[a]) != driving) continue;
    for (std::size_t b = 0; b < out.size(); ++b) {
      const Eigen::ArrayXd part = m.accel.col(static_cast<Eigen::Index>(a))
                                      .segment(static_cast<Eigen::Index>(b) * block, block)
                                      .array();
      if (part.isFinite().all())
        out[b] = std::max(out[b], std::sqrt((part - part.mean()).square().mean()));
    }
  }
  return out;
}

/// Returns true for each block that moves.
std::vector<bool> moving(const std::vector<double>& rms, double noise, double share) {
  std::vector<double> ordered = rms;
  std::sort(ordered.begin(), ordered.end());
  const double strongest = ordered.empty() ? 0 : ordered[(ordered.size() - 1) * 98 / 100];
  const double threshold = std::max(4 * noise, share * strongest);
  std::vector<bool> out;
  for (const double value : rms) out.push_back(value > threshold && value > 0);
  return out;
}

double worst_noise(const SessionMotion& m, bool driving) {
  double worst = 0;
  for (const estimator::SensorAxis& axis : m.axes)
    if (drives(axis) == driving)
      worst = std::max(worst, axis.noise_density * std::sqrt(m.rate_hz / 2));
  return worst;
}

}  // namespace

std::int64_t SessionMotion::time_us(Eigen::Index row) const {
  return first_us + std::llround(1e6 * static_cast<double>(row) / rate_hz);
}

Eigen::Index SessionMotion::row_at(std::int64_t time_us) const {
  const double row = std::ceil(1e-6 * static_cast<double>(time_us - first_us) * rate_hz - 1e-3);
  return std::clamp<Eigen::Index>(static_cast<Eigen::Index>(row), 0, accel.rows());
}

std::optional<SessionMotion> read_session_motion(const Config& config,
                                                 const std::vector<std::string>& paths,
                                                 std::vector<std::string>& problems,
                                                 const RecordFileArguments& declared) {
  ReplaySurvey survey(config, true);
  survey.declare(declared);
  for (const std::string& path : paths) survey.add(path);
  survey.finish();
  problems = survey.problems();
  if (!problems.empty()) return std::nullopt;
  Collector collector(config.pipeline);
  drivers::AccelIntake intake(
      wanted_axes(config), [&](const estimator::AccelSample& sample) { collector.push(sample); },
      intake_settings(config));
  for (const ReplayInput& input : survey.inputs()) {
    const std::string problem =
        push_stored_samples(config, input, intake,
                            [&](const estimator::AccelSample& sample) { collector.push(sample); });
    if (!problem.empty()) problems.push_back(problem);
  }
  collector.finish();
  if (collector.too_long())
    problems.push_back(fmt::format("the raw samples span more than {} values", kMaxValues));
  SessionMotion out{config.pipeline.options.rate_hz, collector.first_us(), collector.axes(),
                    collector.accel(), survey.notes()};
  if (out.accel.rows() < 2) problems.push_back("the raw samples hold no motion");
  if (!problems.empty()) return std::nullopt;
  return out;
}

const char* stage_word(StageKind kind) {
  return kind == StageKind::quiet    ? "quiet"
         : kind == StageKind::forced ? "forced vibration"
                                     : "free vibration";
}

std::vector<Stage> find_stages(const SessionMotion& m) {
  constexpr double kBlock_s = 0.5, kShortest_s = 1;
  const auto block = static_cast<Eigen::Index>(std::max(2.0, std::round(kBlock_s * m.rate_hz)));
  const std::vector<bool> base = moving(block_rms(m, true, block), worst_noise(m, true), 0.02);
  const std::vector<bool> floors = moving(block_rms(m, false, block), worst_noise(m, false), 0.01);
  std::vector<Stage> out;
  const auto append = [&](StageKind kind, std::int64_t from_us, std::int64_t to_us) {
    if (!out.empty() && out.back().kind == kind)
      out.back().to_us = to_us;
    else
      out.push_back({kind, from_us, to_us});
  };
  for (std::size_t b = 0; b < base.size(); ++b)
    append(base[b]     ? StageKind::forced
           : floors[b] ? StageKind::free
                       : StageKind::quiet,
           m.time_us(static_cast<Eigen::Index>(b) * block),
           m.time_us(static_cast<Eigen::Index>(b + 1) * block));
  // A zero crossing of the ground is not a pause: short stages join the one before.
  std::vector<Stage> whole;
  whole.swap(out);
  for (const Stage& stage : whole)
    append(stage.seconds() < kShortest_s && !out.empty() ? out.back().kind : stage.kind,
           stage.from_us, stage.to_us);
  if (!out.empty()) out.back().to_us = m.time_us(m.accel.rows() - 1);
  return out;
}

}  // namespace framewatch::daemon
