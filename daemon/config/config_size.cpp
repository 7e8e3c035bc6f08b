// SPDX-License-Identifier: MIT
#include "daemon/config/config_size.h"

#include <algorithm>
#include <iterator>

#include <fmt/core.h>

#include "estimator/motion/sample.h"
#include "estimator/pipeline/pipeline_size.h"

namespace framewatch::daemon {
namespace {

constexpr double kUsualWindowRows = 2000;  // with more rows the window is the cause
constexpr double kMega = 1024.0 * 1024;

struct Share {
  double bytes;
  const char *section, *key;
};

TextPlace place_of(const TomlValue& document, const Share& share) {
  const TomlEntry* section = document.find(share.section);
  if (section == nullptr) return {1, 1};
  const TomlEntry* key = section->value.find(share.key);
  return key != nullptr ? key->value.place : section->place;
}

/// Returns the samples around a gap that wait to be stored.
double segment_bytes(const Config& config) {
  if (!config.gap || config.gap->store.empty()) return 0;
  const GapSettings& gap = *config.gap;
  return 1.2 * (gap.before_s + gap.after_s + gap.options.lasting_s) *
         config.pipeline.options.rate_hz * static_cast<double>(config.pipeline.axes.size()) *
         sizeof(estimator::AccelSample);
}

std::string size_words(double bytes) {
  return bytes < 1024 * kMega ? fmt::format("{:.0f} MiB", bytes / kMega)
                              : fmt::format("{:.3g} GiB", bytes / (1024 * kMega));
}

}  // namespace

std::string simulated_size_problem(const estimator::Structure& structure) {
  if (structure.degrees_of_freedom() <= kMaxSimulatedFreedoms) return {};
  return fmt::format(
      "{} stories of {} frames have {} degrees of freedom, a building of at most {} is simulated",
      structure.stories, structure.frames(), structure.degrees_of_freedom(), kMaxSimulatedFreedoms);
}

void check_size(const TomlValue& document, const Config& config,
                std::vector<TextProblem>& problems) {
  const std::string simulated = simulated_size_problem(config.pipeline.structure);
  if (config.gap && !simulated.empty())
    problems.push_back({document.find("gap")->place, "gap: " + simulated});
  const estimator::PipelineConfig& c = config.pipeline;
  const estimator::EstimatorOptions& o = c.options;
  const estimator::PipelineSize size = estimator::pipeline_size(c);
  const double segments = segment_bytes(config);
  const double total = size.bytes() + segments;
  if (total <= kMaxConfigBytes) return;
  double longest_s = std::max(o.window_s, o.long_window_s);
  for (const double s : o.other_windows_s) longest_s = std::max(longest_s, s);
  const bool slow_filter = 1 / o.high_pass_hz > longest_s;
  const bool long_windows = o.window_s * o.rate_hz > kUsualWindowRows;
  const Share shares[] = {
      {size.sums, long_windows ? "estimator" : "structure", long_windows ? "window_s" : "stories"},
      {size.solvers, "structure", "stories"},
      {size.motion, "estimator", slow_filter ? "high_pass_hz" : "window_s"},
      {size.noise, "estimator", "high_pass_hz"},
      {size.boxplots, "estimator", "boxplot_windows"},
      {size.open, "estimator", "lateness_s"},
      {segments, "gap", "lasting_s"}};
  const Share& most =
      *std::max_element(std::begin(shares), std::end(shares),
                        [](const Share& a, const Share& b) { return a.bytes < b.bytes; });
  problems.push_back(
      {place_of(document, most),
       fmt::format("{}.{}: the estimation would take about {} of memory, {} of them on account of "
                   "this key; at most {} is allowed ({} stories of {} frames and {} panels, {} "
                   "channels, {:g} Hz, windows of {:g} s to {:g} s, high_pass_hz {:g}, "
                   "boxplot_windows {}, lateness_s {:g})",
                   most.section, most.key, size_words(total), size_words(most.bytes),
                   size_words(kMaxConfigBytes), c.structure.stories, c.structure.frames(),
                   c.structure.panels(), c.axes.size(), o.rate_hz, o.window_s, longest_s,
                   o.high_pass_hz, o.boxplot_windows, o.lateness_s)});
}

}  // namespace framewatch::daemon
