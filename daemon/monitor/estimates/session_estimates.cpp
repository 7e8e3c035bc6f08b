// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/session_estimates.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <framewatch/window_estimate_t.hpp>

#include <fmt/core.h>

#include "daemon/monitor/estimates/estimate_series.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxNotes = 20, kMaxEvents = 10000;

class Reader {
 public:
  explicit Reader(SessionEstimates& session) : session_(session) {}

  void take(const drivers::LogEvent& event) {
    const auto kind = drivers::fingerprint(event.data);
    if (kind == window_estimate_t::getHash()) {
      // The channels of the other windows extend the name of the main one.
      if (channel_.empty() || event.channel.size() < channel_.size()) {
        channel_ = event.channel;
        start();
      }
      if (event.channel == channel_) estimate(event);
    } else if (kind == parameter_table_t::getHash()) {
      table(event);
    } else if (kind == status_t::getHash()) {
      if (auto status = drivers::decoded<status_t>(event.data))
        session_.status = std::move(*status);
    } else if (kind == watch_t::getHash()) {
      if (auto watch = drivers::decoded<watch_t>(event.data);
          watch && watch->parameters == session_.table.parameters)
        session_.watch = std::move(*watch);
    } else if (kind == model_fit_t::getHash()) {
      model_fit(event);
    } else if (kind == event_t::getHash() && session_.events.size() < kMaxEvents) {
      if (auto found = drivers::decoded<event_t>(event.data))
        session_.events.push_back(std::move(*found));
    }
  }
  void note(std::string text) {
    if (++notes_ <= kMaxNotes) session_.notes.push_back(std::move(text));
  }
  bool has_table() const { return has_table_; }

 private:
  void follow(const std::string& channel) {
    channel_ = channel;
    start();
  }
  void start() {
    const auto count = static_cast<std::size_t>(session_.table.parameters);
    session_.start_us.clear();
    session_.end_us.clear();
    session_.residual_ratio.clear();
    session_.value.assign(count, {});
    session_.std_error.assign(count, {});
    session_.reason.assign(count, {});
  }
  void table(const drivers::LogEvent& event) {
    auto table = drivers::decoded<parameter_table_t>(event.data);
    if (!table) return note(fmt::format("byte {}: no sound parameter_table_t", event.offset));
    if (!has_table_) {
      session_.table = std::move(*table);
      has_table_ = true;
      start();
    } else if (table->name != session_.table.name) {
      note(fmt::format("byte {}: another building's parameter table", event.offset));
    }
  }
  void estimate(const drivers::LogEvent& event) {
    const auto e = drivers::decoded<window_estimate_t>(event.data);
    if (!e || !has_table_ || e->parameters != session_.table.parameters)
      return note(fmt::format("byte {}: an estimate that fits no parameter table", event.offset));
    session_.start_us.push_back(e->window_start_us);
    session_.end_us.push_back(e->window_end_us);
    session_.residual_ratio.push_back(e->status == 0 ? estimator::kNaN : e->residual_ratio);
    for (std::size_t p = 0; p < session_.value.size(); ++p) {
      const bool known = e->reason[p] == 0 && std::isfinite(e->value[p]);
      session_.value[p].push_back(known ? e->value[p] : estimator::kNaN);
      session_.std_error[p].push_back(known ? e->std_error[p] : estimator::kNaN);
      const int reason = told_reason(e->reason[p], static_cast<double>(e->snr[p]), min_snr_);
      session_.reason[p].push_back(static_cast<std::uint8_t>(std::clamp(reason, 0, kReasons - 1)));
    }
  }

  void model_fit(const drivers::LogEvent& event) {
    const auto fit = drivers::decoded<model_fit_t>(event.data);
    if (fit && has_table_ && fit->parameters == session_.table.parameters)
      session_.model_fit.push_back({fit->window_end_us, fit->error, fit->word});
  }

  SessionEstimates& session_;
  const double min_snr_ = estimator::EstimatorOptions{}.min_snr;  // not in the log
  std::string channel_;
  bool has_table_ = false;
  std::size_t notes_ = 0;
};

}  // namespace

std::optional<SessionEstimates> read_session_estimates(const std::string& path,
                                                       std::vector<drivers::Problem>& problems) {
  SessionEstimates session;
  Reader reader(session);
  drivers::LcmLogReader log;
  drivers::LogEvent event;
  auto read = log.open(path) ? log.next(event) : drivers::LogRead::error;
  for (; read != drivers::LogRead::end && read != drivers::LogRead::error; read = log.next(event)) {
    if (read == drivers::LogRead::event)
      reader.take(event);
    else
      reader.note(fmt::format("byte {}: {} bytes left out: {}", log.damage().offset,
                              log.damage().bytes, log.damage().reason));
  }
  if (read == drivers::LogRead::error)
    problems.push_back({path, log.error()});
  else if (!reader.has_table())
    problems.push_back({path, "there is no parameter_table_t to name the parameters"});
  else if (session.windows() == 0)
    problems.push_back({path, "there is no estimate in it"});
  if (!problems.empty()) return std::nullopt;
  return session;
}

bool SessionEstimates::compared(std::size_t p) const {
  return watch && p < watch->baseline.size() && watch->watched[p] != 0 &&
         (std::isfinite(watch->baseline[p]) || std::isfinite(watch->quiet_baseline[p]));
}

WindowRange windows_within(const SessionEstimates& session, std::int64_t from_us,
                           std::int64_t to_us) {
  WindowRange range;
  while (range.from < session.windows() && session.start_us[range.from] < from_us) ++range.from;
  range.to = range.from;
  while (range.to < session.windows() && session.end_us[range.to] <= to_us) ++range.to;
  return range;
}

const ModelFitTold* model_fit_at_end(const SessionEstimates& s, WindowRange windows) {
  if (windows.size() == 0) return nullptr;
  const ModelFitTold* out = nullptr;
  for (const ModelFitTold& told : s.model_fit)
    if (told.end_us >= s.end_us[windows.from] && told.end_us <= s.end_us[windows.to - 1])
      out = &told;
  return out;
}

estimator::BoxplotStatistics boxplot_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty())
    return {estimator::kNaN, estimator::kNaN, estimator::kNaN, estimator::kNaN, estimator::kNaN};
  std::sort(values.begin(), values.end());
  const auto [q1, median, q3] = quartiles_of(values);
  estimator::BoxplotStatistics out{q1, median, q3, estimator::kNaN, estimator::kNaN};
  const double reach = 1.5 * (out.q3 - out.q1);
  const auto first = std::lower_bound(values.begin(), values.end(), out.q1 - reach);
  const auto beyond = std::upper_bound(first, values.end(), out.q3 + reach);
  out.whisker_low = *first;
  out.whisker_high = *(beyond - 1);
  out.count = static_cast<int>(values.size());
  out.outliers = out.count - static_cast<int>(beyond - first);
  return out;
}

}  // namespace framewatch::daemon
