// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

constexpr double kLongestFirst_s = 60;
constexpr std::size_t kMaxPeriods = 6;

/// Returns the rule that the periods break, or an empty text.
std::string problem_of(const std::vector<double>& periods_s) {
  if (periods_s.empty() || periods_s.size() > kMaxPeriods) return "must be 1 to 6 periods";
  if (periods_s.front() > kLongestFirst_s) return "must begin with at most 60 s";
  for (std::size_t i = 0; i < periods_s.size(); ++i) {
    if (periods_s[i] != std::floor(periods_s[i])) return "must be whole seconds";
    if (i > 0 &&
        (periods_s[i] <= periods_s[i - 1] || std::fmod(periods_s[i], periods_s[i - 1]) > 0))
      return "must ascend, each a multiple of the one before";
  }
  return {};
}

}  // namespace

std::optional<GapSettings> read_gap(const TomlValue& document, std::vector<TextProblem>& problems) {
  if (!document.find("gap")) return std::nullopt;
  return ConfigSection("gap", document, problems).read<GapSettings>();
}

std::optional<HistorySettings> read_history(const TomlValue& document,
                                            std::vector<TextProblem>& problems) {
  if (!document.find("history")) return std::nullopt;
  ConfigSection section("history", document, problems);
  auto out = section.read<HistorySettings>();
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  if (section.given("summary_s"))
    if (const std::string rule = problem_of(section.list("summary_s"));
        section.good("summary_s") && !rule.empty())
      section.problem("summary_s", rule);
  return out;
}

std::optional<EventReportSettings> read_event_report(const TomlValue& document,
                                                     std::vector<TextProblem>& problems) {
  if (!document.find("event_report")) return std::nullopt;
  ConfigSection section("event_report", document, problems);
  auto out = section.read<EventReportSettings>();
  if (section.given("directory") && out.directory.empty())
    section.problem("directory", "must not be empty");
  if (out.red_drift_ratio < out.yellow_drift_ratio)
    section.problem("red_drift_ratio", "must not be below yellow_drift_ratio");
  if (out.red_loss_ratio < out.yellow_loss_ratio)
    section.problem("red_loss_ratio", "must not be below yellow_loss_ratio");
  return out;
}

std::optional<WatchSettings> read_watch(const TomlValue& document,
                                        std::vector<TextProblem>& problems) {
  if (!document.find("watch")) return std::nullopt;
  ConfigSection section("watch", document, problems);
  auto out = section.read<WatchSettings>();
  out.options.temperature = !out.temperature_channel.empty();
  return out;
}

}  // namespace framewatch::daemon
