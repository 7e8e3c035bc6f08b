// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/first_passes.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include <fmt/core.h>

#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {
namespace {

/// Returns the configuration without the parts that only read the estimates.
Config tuning_only(const Config& config) {
  Config out = config;
  out.watch.reset();
  out.gap.reset();
  out.event_report.reset();
  out.pipeline.options.other_windows_s.clear();
  out.pipeline.options.long_window_s = 0;
  out.pipeline.options.boxplot_windows = 0;
  out.pipeline.options.hop_s = out.pipeline.options.window_s;
  return out;
}

/// Returns true if no filter's corner moved by more than kMoved. Corners follow the square roots of
/// the stiffnesses.
bool holds(const estimator::ParameterTable& table, const Eigen::VectorXd& before,
           const Eigen::VectorXd& now) {
  for (int p = 0; p < table.size(); ++p)
    if (table[p].kind == estimator::ParameterKind::frame_stiffness &&
        std::abs(std::sqrt(now[p] / before[p]) - 1) > FirstPasses::kMoved)
      return false;
  return true;
}

/// Runs one pass over the input, beginning with the tuning `start`.
class Pass : private EstimationListener {
 public:
  Pass(const Config& config, const std::optional<estimator::Tuning>& start)
      : estimation_(config, {}, this) {
    if (start) estimation_.start_tuned(*start);
    began_ = held_ = theta0();
  }

  /// Returns false when the input cannot be read.
  bool read(const Config& config, const TuningInput& input,
            const std::function<void(std::int64_t bytes)>& progress) {
    ReplaySurvey survey(config, input.salvage, input.span);
    survey.declare(input.record);
    survey.feed(estimation_);
    survey.end_when([this] { return windows_ >= FirstPasses::kEnough; });
    if (progress) survey.at_each([&](std::int64_t bytes, std::int64_t) { progress(bytes); });
    input.add_to(survey);
    if (!survey.problems().empty()) return false;
    estimation_.finish();
    return true;
  }

  /// Returns nullopt when the record shows too little motion to tune on.
  std::optional<estimator::Tuning> tuning() const {
    std::optional<estimator::Tuning> out = estimation_.pipeline().tuning();
    if (out && !out->found_right && out->theta0 == began_) out.reset();
    return out;
  }
  bool settled() const { return windows_ >= FirstPasses::kHolds || same_as(began_); }

 private:
  const Eigen::VectorXd& theta0() const { return estimation_.pipeline().theta0(); }
  bool same_as(const Eigen::VectorXd& before) const {
    return holds(estimation_.pipeline().parameters(), before, theta0());
  }
  void on_estimate(const estimator::WindowEstimate& window) override {
    if (!same_as(held_)) {
      held_ = theta0();
      windows_ = 0;
    }
    windows_ += window.status == estimator::WindowStatus::valid;
  }

  Estimation estimation_;
  Eigen::VectorXd began_, held_;  ///< parameters at the pass's start and at the last move
  int windows_ = 0;               ///< windows with values since held_
};

}  // namespace

void TuningInput::add_to(ReplaySurvey& survey) const {
  for (const std::string& path : paths) survey.add(path);
  for (const NamedRecord& r : records) survey.add(r.name, r.record);
}

std::int64_t TuningInput::bytes() const {
  std::int64_t sum = 0;
  for (const std::string& path : paths) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (!error) sum += static_cast<std::int64_t>(size);
  }
  for (const NamedRecord& r : records) sum += bytes_of(r.record);
  return sum;
}

bool can_be_tuned(const Config& config) {
  const estimator::EstimatorOptions& o = config.pipeline.options;
  return o.self_tune &&
         (o.variant == estimator::Variant::matched || config.pipeline.parameters().grouped());
}

FirstPasses::FirstPasses(const Config& config, const TuningInput& input,
                         const std::function<void(std::int64_t bytes)>& progress) {
  if (!can_be_tuned(config)) return;
  const Config reduced = tuning_only(config);
  for (bool settled = false; !settled && passes_ < kMaxPasses;) {
    Pass pass(reduced, tuning_);
    const bool whole = read_ = pass.read(reduced, input, progress);
    tuning_ = whole ? pass.tuning() : std::nullopt;
    if (!tuning_) return;
    ++passes_;
    settled = pass.settled();
  }
}

std::string FirstPasses::note() const {
  return tuning_ ? fmt::format("tuned on the record first: {} passes", passes_ + 1)
                 : "the record shows too little motion to tune on first; estimating in one pass";
}

}  // namespace framewatch::daemon
