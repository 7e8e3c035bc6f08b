#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/tools/replay/replay_survey.h"

namespace framewatch::daemon {
namespace {

constexpr double kRateTolerance = 0.02;
constexpr std::size_t kRateLag = 100;  ///< samples; times may be rounded to whole milliseconds

std::string list(const std::map<std::string, std::int64_t>& channels) {
  std::string text;
  int shown = 0;
  for (const auto& [name, count] : channels) {
    if (++shown > 10) return text + ", ...";
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", name, count);
  }
  return text;
}

}  // namespace

void ReplaySurvey::judge_log(const std::string& path, const LogSeen& seen, std::int64_t malformed) {
  if (seen.is_raw) {
    judge_raw_log(path, seen);
    return;
  }
  const std::string malformed_text = fmt::format(
      "{}: byte {}: {} messages on our channels are no accel_t or channel_table_t, the first: {}",
      path, seen.first_malformed_offset, malformed, seen.malformed);
  if (malformed > 0 && seen.samples > 0) fault(malformed_text);
  if (malformed > 0 && seen.samples == 0) problems_.push_back(malformed_text);
  if (seen.elsewhere_offset >= 0)
    fault(
        fmt::format("{}: byte {}: a channel table says that channels are elsewhere than their "
                    "source in {}, which holds; a record becomes a log that agrees by "
                    "framewatch convert --config",
                    path, seen.elsewhere_offset, config_.path));
  if (seen.renamed_offset >= 0)
    notes_.push_back(
        fmt::format("{}: byte {}: a channel table has other names than {} at the "
                    "sources of its channels, which hold",
                    path, seen.renamed_offset, config_.path));
  if (seen.infinite_offset >= 0)
    fault(fmt::format("{}: byte {}: infinite acceleration", path, seen.infinite_offset));
  if (seen.events == 0)
    problems_.push_back(fmt::format("{}: holds no intact LCM event", path));
  else if (seen.samples == 0 && malformed == 0 && !seen.left_out)
    problems_.push_back(fmt::format("{}: no message for the channels of {}; it has {}", path,
                                    config_.path, list(seen.channels)));
  const bool in_order = seen.samples == 0 || extend(path, log_first_us_, log_last_us_);
  if (in_order && seen.backwards_offset >= 0)
    problems_.push_back(fmt::format(
        "{}: byte {}: time runs backwards: a node's sample is not newer than the one before", path,
        seen.backwards_offset));
  std::sort(stamps_.begin(), stamps_.end(),
            [](const NodeStamps& a, const NodeStamps& b) { return a.place < b.place; });
  for (const auto& [node, stamps] : stamps_) {
    if (stamps.empty()) continue;
    const std::size_t lag = std::min(kRateLag, stamps.size() - 1);
    std::vector<double> steps;
    for (std::size_t i = lag; lag > 0 && i < stamps.size(); ++i) {
      const auto sequence_step = stamps[i].sequence - stamps[i - lag].sequence;
      const auto time_step_us = stamps[i].time_us - stamps[i - lag].time_us;
      if (sequence_step > 0 && time_step_us > 0)
        steps.push_back(static_cast<double>(time_step_us) / static_cast<double>(sequence_step));
    }
    if (steps.empty()) continue;
    check_rate(fmt::format("{}: {} node {}", path, node.first, node.second),
               1e6 / median(std::move(steps)));
  }
}

void ReplaySurvey::check_rate(const std::string& place, double rate_hz) {
  const double configured = config_.pipeline.options.rate_hz;
  if (std::abs(rate_hz / configured - 1) > kRateTolerance)
    problems_.push_back(fmt::format("{}: sampled at {:.4g} Hz, but {} says rate_hz = {:g}", place,
                                    rate_hz, config_.path, configured));
}

}  // namespace framewatch::daemon
