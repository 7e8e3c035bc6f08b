// SPDX-License-Identifier: MIT
#include "drivers/lcm/accel_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <framewatch/accel_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include <fmt/core.h>

#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "drivers/records/record_builder.h"
#include "estimator/numeric/quantile.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

std::string default_name(std::int32_t node, std::int32_t axis) {
  return fmt::format("node{}.{}", node, kAxes[static_cast<std::size_t>(axis)]);
}

/// Returns 1 / the median step of sorted samples; 0 when no step is positive.
double usual_rate(const std::vector<SensorNodeSample>& samples) {
  std::vector<std::int64_t> steps_us;
  for (std::size_t i = 1; i < samples.size(); ++i)
    if (samples[i].time > samples[i - 1].time)
      steps_us.push_back((samples[i].time - samples[i - 1].time).count());
  if (steps_us.empty()) return 0;
  return 1e6 / static_cast<double>(estimator::lower_median(steps_us));
}

/// Collects the samples of one channel and its table.
class AccelLog {
 public:
  AccelLog(std::string path, std::string channel, std::vector<Problem>& problems)
      : path_(std::move(path)), channel_(std::move(channel)), problems_(problems) {}

  bool take(const LogEvent& event) {
    if (event.channel == channel_) return take_sample(event);
    if (event.channel == channel_ + "_CHANNELS") return take_table(event);
    return true;
  }

  std::optional<Record> record() {
    if (samples_.empty()) problems_.push_back({path_, "no samples on " + channel_});
    std::size_t most = 0;
    double rate_hz = table_ ? table_->rate_hz : 0;
    for (auto& [node, samples] : samples_) {
      std::stable_sort(
          samples.begin(), samples.end(),
          [](const SensorNodeSample& a, const SensorNodeSample& b) { return a.time < b.time; });
      if (samples.size() > most && !(table_ && table_->rate_hz > 0)) rate_hz = usual_rate(samples);
      most = std::max(most, samples.size());
    }
    if (samples_.size() * most > RecordBuilder::kMaxValues / 4)
      problems_.push_back(
          {path_, fmt::format("{} nodes with up to {} samples exceed the limit of {} samples",
                              samples_.size(), most, RecordBuilder::kMaxValues / 4)});
    if (!problems_.empty()) return std::nullopt;
    std::vector<Record> nodes;
    std::vector<std::string> where;
    for (auto& [node, samples] : samples_) {
      where.push_back(fmt::format("{}: node {}", path_, node));
      auto node_record = record_of_node(node, samples, rate_hz, most, where.back());
      if (node_record) nodes.push_back(std::move(*node_record));
    }
    if (!problems_.empty()) return std::nullopt;
    auto merged = merge_records(std::move(nodes), where, MergeSpan::all, problems_);
    if (!merged) return std::nullopt;
    return selected(std::move(*merged));
  }

 private:
  bool refuse(const LogEvent& event, const std::string& message) {
    problems_.push_back({place_of(path_, event), message});
    return false;
  }

  bool take_sample(const LogEvent& event) {
    const auto sample = decode_accel(event.data.data(), event.data.size());
    if (!sample) return refuse(event, fmt::format("{}: the message is not an accel_t", channel_));
    if (++count_ > RecordBuilder::kMaxValues / 4)
      return refuse(event, fmt::format("more than {} samples", RecordBuilder::kMaxValues / 4));
    samples_[sample->node].push_back(*sample);
    return true;
  }

  bool take_table(const LogEvent& event) {
    auto table = decode_channel_table(event.data.data(), event.data.size());
    if (!table) return refuse(event, fmt::format("{}: not a channel_table_t", event.channel));
    std::vector<std::string> names;
    for (const ChannelTable::Entry& entry : table->entries) names.push_back(entry.name);
    FileProblems problems(place_of(path_, event), problems_);
    check_names(names, 0, problems);
    if (problems.any()) return false;
    for (const ChannelTable::Entry& entry : table->entries)
      if (entry.axis < 0 || entry.axis > 2)
        return refuse(event, fmt::format("axis {} must be 0, 1 or 2", entry.axis));
    if (table_ && *table_ != *table)
      return refuse(event,
                    "the channel table changes within the log: convert the parts separately");
    table_ = std::move(table);
    return true;
  }

  std::optional<Record> record_of_node(std::int32_t node, std::vector<SensorNodeSample>& samples,
                                       double rate_hz, std::size_t most, const std::string& where) {
    FileProblems problems(where, problems_);
    RecordBuilder builder({default_name(node, 0), default_name(node, 1), default_name(node, 2)},
                          problems);
    if (std::isfinite(rate_hz) && rate_hz > 0) builder.expect(rate_hz, 2 * most);
    std::int64_t repeated = 0;
    std::int64_t infinite = 0;
    std::optional<estimator::Time> last;
    for (SensorNodeSample& sample : samples) {
      if (last == sample.time) {
        ++repeated;
        continue;
      }
      last = sample.time;
      for (double& value : sample.accel_abs_mps2) {
        if (!std::isinf(value)) continue;
        ++infinite;
        value = std::numeric_limits<double>::quiet_NaN();
      }
      builder.add(0, static_cast<double>(to_microseconds(sample.time)) / 1e6,
                  sample.accel_abs_mps2);
    }
    auto record = builder.finish();
    if (!record) return std::nullopt;
    // A node need not have all three axes.
    std::erase_if(record->notes, [&](const std::string& note) {
      return note.find("have no value") != std::string::npos;
    });
    if (repeated > 0) record->notes.push_back(fmt::format("{} samples came twice", repeated));
    if (infinite > 0) record->notes.push_back(fmt::format("{} values were infinite", infinite));
    return record;
  }

  Record selected(Record merged) const {
    Record record;
    record.time_s = std::move(merged.time_s);
    record.rate_hz = merged.rate_hz;
    record.notes = std::move(merged.notes);
    const auto keep = [&](const std::string& name, const std::string& source) {
      const auto at = std::find(merged.names.begin(), merged.names.end(), source);
      record.names.push_back(name);
      if (at == merged.names.end()) {
        record.notes.push_back(fmt::format("{}: {} has no samples", path_, name));
        record.accel_mps2.emplace_back(record.time_s.size(),
                                       std::numeric_limits<double>::quiet_NaN());
        return;
      }
      record.accel_mps2.push_back(
          merged.accel_mps2[static_cast<std::size_t>(at - merged.names.begin())]);
    };
    if (table_)
      for (const ChannelTable::Entry& entry : table_->entries)
        keep(entry.name, default_name(entry.node, entry.axis));
    else
      for (std::size_t i = 0; i < merged.names.size(); ++i)
        if (std::any_of(merged.accel_mps2[i].begin(), merged.accel_mps2[i].end(),
                        [](double v) { return !std::isnan(v); }))
          keep(merged.names[i], merged.names[i]);
    return record;
  }

  std::string path_;
  std::string channel_;
  std::vector<Problem>& problems_;
  std::map<std::int32_t, std::vector<SensorNodeSample>> samples_;
  std::size_t count_ = 0;
  std::optional<ChannelTable> table_;
};

constexpr std::int64_t kTablePeriodUs = 1'000'000;

bool write_messages(LcmLogWriter& log, std::int64_t time_us, const std::vector<Message>& messages) {
  for (const Message& message : messages)
    if (!log.write(time_us, message.channel, message.bytes.data(), message.bytes.size()))
      return false;
  return true;
}

}  // namespace

std::string write_accel_log(const std::string& path, const Record& record,
                            const std::vector<AxisAddress>& addresses, std::int64_t start_us,
                            const std::function<void(double)>& progress) {
  AccelMessages messages(record.names, addresses, record.rate_hz);
  LcmLogWriter log;
  if (!log.open(path)) return log.error();
  std::vector<double> values(record.names.size());
  std::int64_t next_table_us = INT64_MIN;
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const std::int64_t time_us = start_us + std::llround(record.time_s[i] * 1e6);
    if (time_us >= next_table_us) {
      if (!write_messages(log, time_us, messages.tables(time_us))) return log.error();
      next_table_us = time_us + kTablePeriodUs;
      if (progress) progress(static_cast<double>(i) / static_cast<double>(record.time_s.size()));
    }
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = record.accel_mps2[c][i];
    if (!write_messages(log, time_us, messages.samples(time_us, values))) return log.error();
  }
  return log.close() ? "" : log.error();
}

std::optional<LogContents> log_contents(const std::string& path, std::vector<Problem>& problems) {
  LogContents contents;
  std::map<std::string, std::pair<std::int64_t, std::string>> kinds;
  const bool whole = for_each_event(
      path,
      [&](const LogEvent& event) {
        ++contents.events;
        constexpr std::size_t kMaxChannels = 100'000;
        if (kinds.size() < kMaxChannels && !kinds.contains(event.channel))
          kinds.emplace(event.channel, std::pair(fingerprint(event.data).value_or(0),
                                                 why_not("accel_t", event.data)));
        return true;
      },
      problems);
  if (!whole) return std::nullopt;
  if (contents.events == 0) {
    problems.push_back({path, "the log is empty"});
    return std::nullopt;
  }
  for (const auto& [channel, kind] : kinds) {
    if (kind.first == accel_t::getHash()) {
      contents.accel.push_back(channel);
    } else if (kind.first == window_estimate_t::getHash()) {
      contents.estimates.push_back(channel);
    } else {
      contents.others.push_back(channel);
      contents.reasons.push_back(kind.second);
    }
  }
  return contents;
}

std::optional<Record> read_accel_log(const std::string& path, const std::string& channel,
                                     std::vector<Problem>& problems) {
  AccelLog log(path, channel, problems);
  const bool whole = for_each_event(
      path, [&](const LogEvent& event) { return log.take(event); }, problems);
  if (!whole || !problems.empty()) return std::nullopt;
  return log.record();
}

}  // namespace framewatch::drivers
