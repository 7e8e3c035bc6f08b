// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/estimate_table.h"

#include <cmath>

#include <fmt/core.h>

#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

bool is_stiffness(int kind) {
  return kind == static_cast<int>(estimator::ParameterKind::frame_stiffness) ||
         kind == static_cast<int>(estimator::ParameterKind::panel_stiffness);
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.5g}", value) : std::string("-");
}

const double kMinSnr = estimator::EstimatorOptions{}.min_snr;  // of the demo, which configures none

bool has_value(const window_estimate_t& e, std::size_t i) {
  return i < e.value.size() && i < e.reason.size() && e.reason[i] == 0 && std::isfinite(e.value[i]);
}

}  // namespace

const char* reason_word(int reason) {
  constexpr std::array<const char*, kReasons> kWords = {
      "ok",           "warming up",   "quiet", "floor too stiff", "plan symmetric",
      "channel lost", "too uncertain"};
  return reason >= 0 && reason < kReasons ? kWords[static_cast<std::size_t>(reason)] : "?";
}

EstimateErrors errors_against(const parameter_table_t& table, const window_estimate_t& e,
                              const std::vector<double>& truth) {
  EstimateErrors out;
  for (std::size_t i = 0; i < table.name.size(); ++i) {
    if (!is_stiffness(table.kind[i])) continue;
    const bool frame = table.kind[i] == static_cast<int>(estimator::ParameterKind::frame_stiffness);
    GroupError& group = frame ? out.frames : out.panels;
    if (!has_value(e, i)) {
      group.without.push_back(table.name[i]);
      continue;
    }
    const double error = std::abs(e.value[i] / truth[i] - 1);
    if (group.worst.empty() || error > group.worst_ratio) {
      group.worst_ratio = error;
      group.worst = table.name[i];
    }
  }
  return out;
}

std::vector<std::string> estimate_table(const parameter_table_t& table, const window_estimate_t& e,
                                        const std::vector<double>& truth) {
  constexpr const char* row = "{:<9} {:<11} {:>8} {:>8} {:>7} {:>8} {:<15} {:>8} {:>8} {:>8}";
  std::vector<std::string> lines{fmt::format(row, "parameter", "unit", "truth", "estimate",
                                             "error %", "std err", "status", "q1", "median", "q3")};
  for (std::size_t i = 0; i < table.name.size(); ++i) {
    const bool kilo = is_stiffness(table.kind[i]);
    const double unit = kilo ? 1e-3 : 1;
    const bool known = has_value(e, i);
    const double snr = i < e.snr.size() ? static_cast<double>(e.snr[i]) : estimator::kNaN;
    const auto quartile = [&](const std::vector<double>& values) {
      return i < values.size() ? number(unit * values[i]) : std::string("-");
    };
    lines.push_back(fmt::format(
        row, table.name[i], (kilo ? "k" : "") + table.unit[i], number(unit * truth[i]),
        known ? number(unit * e.value[i]) : "-",
        known ? fmt::format("{:+.2f}", 100 * (e.value[i] / truth[i] - 1)) : "-",
        known && i < e.std_error.size() ? fmt::format("{:.2g}", unit * e.std_error[i]) : "-",
        i < e.reason.size() ? reason_word(told_reason(e.reason[i], snr, kMinSnr)) : "-",
        quartile(e.q1), quartile(e.median), quartile(e.q3)));
  }
  return lines;
}

}  // namespace framewatch::daemon
