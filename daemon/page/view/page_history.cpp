// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/base/json.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/page/view/page_json.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

estimator::SampleSet with_every_floor(estimator::SampleSet set, const estimator::Structure& s,
                                      const estimator::StoryResponse& response) {
  for (int floor = 0; floor <= s.stories; ++floor)
    for (int f = 0; f < s.frames(); ++f) set.accel.push_back(response.floor_accel_mps2(floor, f));
  return set;
}

MotionRows::MotionRows(double rate_hz)
    : stride_(std::max(1, static_cast<int>(std::ceil(rate_hz / kMaxRate_hz)))) {}

void MotionRows::push(const estimator::SampleSet& instant) {
  if (instant.index % stride_ != 0) return;
  if (count_ == kMaxRows) {
    ++left_out_;
    return;
  }
  const std::int64_t time_us = to_microseconds(instant.time);
  if (count_ == 0) first_us_ = time_us;
  rows_ += fmt::format("{}[{},{}]", count_ == 0 ? "" : ",", time_us - first_us_,
                       json_list(instant.accel, "{:.5g}"));
  ++count_;
}

std::string MotionRows::take() {
  if (count_ == 0) return {};
  std::string out =
      fmt::format(R"({{"first_us":{},"rows":[{}],"left_out":{}}})", first_us_, rows_, left_out_);
  count_ = 0;
  rows_.clear();
  return out;
}

using estimator::kNaN;

void clear_values(window_estimate_t& e, std::size_t parameters) {
  for (auto* list : {&e.value, &e.std_error}) list->assign(parameters, kNaN);
  for (const BoxColumn& column : kBoxColumns) (e.*column.values).assign(parameters, kNaN);
  e.outliers.assign(parameters, 0);
  e.boxplot_count.assign(parameters, 0);
}

PageHistory::PageHistory(const estimator::PipelineConfig& config) : config_(config) {}

void PageHistory::instant(const estimator::SampleSet& set) {
  for (std::size_t a = 0; a < config_.axes.size(); ++a) {
    const estimator::SensorAxis& axis = config_.axes[a];
    if (axis.story != 0 || !std::isfinite(set.accel[a])) continue;
    const std::size_t d = axis.direction == estimator::Direction::x ? 0 : 1;
    sum_[d] += set.accel[a];
    squares_[d] += set.accel[a] * set.accel[a];
    ++count_[d];
  }
}

void PageHistory::restore(const std::vector<window_estimate_t>& estimates) {
  for (const window_estimate_t& e : estimates) estimate(e);
  now_.assign(now_.size(), false);
}

void PageHistory::estimate(const window_estimate_t& e) {
  keep_last(e);
  const auto step = static_cast<std::int64_t>(1e6 * kEvery_s);
  if (!rows_.empty() && e.window_end_us < rows_.back().end_us) rows_.clear();  // another clock
  if (!rows_.empty() && e.window_end_us - rows_.back().end_us < step) return;
  Row row{e.window_end_us, e.status, e.residual_ratio, {kNaN, kNaN}, e.value, e.std_error};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto n = static_cast<double>(count_[d]);
    if (n > 0)
      row.base_rms[d] = std::sqrt(std::max(0.0, squares_[d] / n - sum_[d] * sum_[d] / n / n));
    sum_[d] = squares_[d] = 0;
    count_[d] = 0;
  }
  rows_.push_back(std::move(row));
  const std::size_t most =
      std::max<std::size_t>(2, kMaxValues / std::max<std::size_t>(1, e.value.size()));
  while (rows_.size() > most ||
         static_cast<double>(e.window_end_us - rows_.front().end_us) > 1e6 * kMost_s)
    rows_.pop_front();
}

bool PageHistory::late(const window_estimate_t& e) {
  const auto row =
      std::lower_bound(rows_.begin(), rows_.end(), e.window_end_us,
                       [](const Row& r, std::int64_t end_us) { return r.end_us < end_us; });
  if (row == rows_.end() || row->end_us != e.window_end_us || row->value.size() != e.value.size())
    return false;
  row->status = e.status;
  row->residual = e.residual_ratio;
  row->value = e.value;
  row->error = e.std_error;
  return true;
}

void PageHistory::keep_last(const window_estimate_t& e) {
  const std::size_t n = e.value.size();
  if (last_us_.size() != n) {
    last_ = {};
    clear_values(last_, n);
    last_us_.assign(n, 0);
    now_.assign(n, false);
  }
  for (std::size_t i = 0; i < e.held_index.size(); ++i) {
    const auto p = static_cast<std::size_t>(e.held_index[i]);
    if (p >= n || e.held_end_us[i] <= last_us_[p]) continue;
    last_.value[p] = e.held_value[i];
    last_.std_error[p] = e.held_std_error[i];
    last_us_[p] = e.held_end_us[i];
  }
  for (std::size_t p = 0; p < n; ++p) {
    now_[p] = e.reason[p] == 0;
    if (!now_[p]) continue;
    last_.value[p] = e.value[p];
    last_.std_error[p] = e.std_error[p];
    last_us_[p] = e.window_end_us;
  }
  if (e.q1.size() != n) return;
  last_.boxplot_windows = e.boxplot_windows;
  last_.boxplots = e.boxplots;
  for (std::size_t p = 0; p < n; ++p) {
    if (!now_[p] || e.boxplot_count[p] == 0) continue;  // keeps the last full box
    for (const BoxColumn& column : kBoxColumns) (last_.*column.values)[p] = (e.*column.values)[p];
    last_.outliers[p] = e.outliers[p];
    last_.boxplot_count[p] = e.boxplot_count[p];
  }
}

void PageHistory::motion(const std::string& json, std::int64_t at, int per_s) {
  motion_.push_back({at, json});
  while (static_cast<double>(at - motion_.front().at) > kMotion_s * per_s) motion_.pop_front();
}

std::string PageHistory::json(double silent_s) const {
  std::string out = fmt::format("{{\"silent_s\":{},\"rows\":[", json_value_text(silent_s));
  for (const Row& row : rows_)
    out += fmt::format("{}[{},{},{},{},{},{},{}]", &row == &rows_.front() ? "" : ",", row.end_us,
                       row.status, json_value_text(row.residual), json_value_text(row.base_rms[0]),
                       json_value_text(row.base_rms[1]), json_list(row.value, "{:.6g}"),
                       json_list(row.error, "{:.3g}"));
  out += "],\"motion\":[";
  for (const Motion& m : motion_) out += (&m == &motion_.front() ? "" : ",") + m.json;
  return out + "]}";
}

std::string PageHistory::last_json() const {
  std::vector<std::size_t> index;
  std::vector<double> value, error;
  std::vector<std::int64_t> end_us;
  for (std::size_t p = 0; p < last_us_.size(); ++p) {
    if (now_[p] || last_us_[p] == 0) continue;
    index.push_back(p);
    value.push_back(last_.value[p]);
    error.push_back(last_.std_error[p]);
    end_us.push_back(last_us_[p]);
  }
  return fmt::format(R"({{"index":{},"value":{},"error":{},"end_us":{}}})", json_list(index),
                     json_list(value, "{:.6g}"), json_list(error, "{:.3g}"), json_list(end_us));
}

std::string PageHistory::boxes_json() const {
  return last_.boxplots > 0 ? daemon::boxes_json(last_) : std::string();
}

}  // namespace framewatch::daemon
