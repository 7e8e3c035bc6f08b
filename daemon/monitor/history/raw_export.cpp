// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/raw_export.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/miniseed_file.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/history/raw_history_reader.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/records/record_csv_writer.h"

namespace framewatch::daemon {
namespace {

struct RawChannel {
  std::string name;
  drivers::AxisAddress address;  ///< LCM address
  std::size_t number =
      0;  ///< among all channels, from 0; does not depend on which ones are exported
};

/// Writes raw samples of a history in the order in which they were received, in m/s^2 before
/// calibration. Methods return false on failure; error() says why.
class RawExport {
 public:
  virtual ~RawExport() = default;
  /// Writes a sample; NaN stands for an invalid value.
  [[nodiscard]] virtual bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) = 0;
  /// Writes another message, if the format can store it.
  [[nodiscard]] virtual bool message(const drivers::LogEvent&) { return true; }
  /// Completes the file, which gets its final name only here.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Returns notes about the file for the user, one line each.
  virtual std::vector<std::string> notes() const { return {}; }
};

std::vector<std::string> names_of(const std::vector<RawChannel>& channels) {
  std::vector<std::string> out;
  for (const RawChannel& c : channels) out.push_back(c.name);
  return out;
}

std::vector<drivers::AxisAddress> addresses_of(const std::vector<RawChannel>& channels) {
  std::vector<drivers::AxisAddress> out;
  for (const RawChannel& c : channels) out.push_back(c.address);
  return out;
}

/// Writes accel_t of the nodes. Numbers missing in a node's sequence stand for samples that were
/// not received.
class LogExport : public RawExport {
 public:
  LogExport(const std::vector<RawChannel>& channels, double rate_hz)
      : channels_(channels),
        step_us_(1e6 / rate_hz),
        tables_(names_of(channels), addresses_of(channels), rate_hz) {}
  bool open(const std::string& path) { return log_.open(path); }

  bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) override {
    const drivers::AxisAddress& a = channels_[channel].address;
    const bool same = open_ && open_->node == a.node && stream_ == a.lcm_channel &&
                      to_microseconds(open_->time) == time_us &&
                      std::isnan(open_->accel_abs_mps2[static_cast<std::size_t>(a.axis)]);
    if (!same && !send()) return false;
    if (!same) {
      open_.emplace();
      open_->time = estimator::from_microseconds(time_us);
      open_->node = a.node;
      open_->accel_abs_mps2.fill(estimator::kNaN);
      stream_ = a.lcm_channel;
    }
    open_->accel_abs_mps2[static_cast<std::size_t>(a.axis)] = accel_mps2;
    return true;
  }
  bool message(const drivers::LogEvent& e) override {
    return send() && log_.write(e.timestamp_us, e.channel, e.data.data(), e.data.size());
  }
  bool close() override { return send() && log_.close(); }
  std::string error() const override { return log_.error(); }

 private:
  bool send() {
    if (!open_) return true;
    drivers::SensorNodeSample sample = *std::exchange(open_, std::nullopt);
    const std::int64_t time_us = to_microseconds(sample.time);
    if (seconds_.passed(time_us))
      for (const drivers::Message& m : tables_.tables(time_us))
        if (!log_.write(time_us, m.channel, m.bytes.data(), m.bytes.size())) return false;
    auto [at, first] = nodes_.try_emplace({stream_, sample.node}, Node{time_us, 0});
    Node& node = at->second;
    if (!first) {
      const double steps = static_cast<double>(time_us - node.time_us) / step_us_;
      node.sequence += steps > 1.5 && steps < 1e9 ? std::llround(steps) : 1;
    }
    node.time_us = time_us;
    sample.sequence = node.sequence;
    const auto bytes = drivers::encode_accel(sample);
    return log_.write(time_us, stream_, bytes.data(), bytes.size());
  }

  struct Node {
    std::int64_t time_us, sequence;
  };
  std::vector<RawChannel> channels_;
  double step_us_;
  drivers::AccelMessages tables_;
  drivers::LcmLogWriter log_;
  std::map<std::pair<std::string, std::int32_t>, Node> nodes_;
  std::optional<drivers::SensorNodeSample> open_;
  std::string stream_;
  SensorSeconds seconds_;
};

/// Writes a record, whose time zero is its first sample.
class CsvExport : public RawExport {
 public:
  explicit CsvExport(const std::vector<RawChannel>& channels) : names_(names_of(channels)) {}
  bool open(const std::string& path) { return csv_.open(path, names_); }
  bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) override {
    if (!zero_us_) zero_us_ = time_us;
    if (time_us <= written_us_) {
      ++out_of_order_;
      return true;
    }
    auto& row = rows_.try_emplace(time_us, names_.size(), estimator::kNaN).first->second;
    row[channel] = accel_mps2;
    // Nodes are never this far behind each other.
    while (rows_.size() > 1 && rows_.begin()->first < time_us - kSecond_us)
      if (!write_first()) return false;
    return true;
  }
  bool close() override {
    while (!rows_.empty())
      if (!write_first()) return false;
    return csv_.close();
  }
  std::string error() const override { return csv_.error(); }
  std::vector<std::string> notes() const override {
    std::vector<std::string> out;
    if (zero_us_) out.push_back(fmt::format("time zero is {}", utc_text(*zero_us_)));
    if (out_of_order_ > 0)
      out.push_back(
          fmt::format("{} samples are left out because the clock went back", out_of_order_));
    return out;
  }

 private:
  bool write_first() {
    const auto at = rows_.begin();
    written_us_ = at->first;
    const bool good = csv_.write(1e-6 * static_cast<double>(at->first - *zero_us_), at->second);
    rows_.erase(at);
    return good;
  }

  std::vector<std::string> names_;
  drivers::RecordCsvWriter csv_;
  std::map<std::int64_t, std::vector<double>> rows_;
  std::optional<std::int64_t> zero_us_;
  std::int64_t written_us_ = INT64_MIN, out_of_order_ = 0;
};

class SeedExport : public RawExport {
 public:
  SeedExport(const std::vector<RawChannel>& channels, double rate_hz, double resolution_mps2,
             const HistoryArguments& names)
      : resolution_mps2_(resolution_mps2),
        file_(seed_channels(channels, rate_hz, names), rate_hz),
        names_(names_of(channels)) {}
  bool open(const std::string& path) { return file_.open(path); }
  bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) override {
    if (std::isnan(accel_mps2)) return true;
    return file_.put(channel, time_us,
                     static_cast<std::int32_t>(std::llround(accel_mps2 / resolution_mps2_)));
  }
  bool close() override { return file_.close(); }
  std::string error() const override { return file_.error(); }
  std::vector<std::string> notes() const override {
    std::vector<std::string> out{fmt::format("one count is {:g} m/s^2", resolution_mps2_)};
    for (std::size_t c = 0; c < names_.size(); ++c)
      out.push_back(fmt::format("{} is {}", file_.seed_name(c), names_[c]));
    return out;
  }

 private:
  static std::vector<SeedChannel> seed_channels(const std::vector<RawChannel>& channels,
                                                double rate_hz, const HistoryArguments& names) {
    std::vector<SeedChannel> out;
    for (const RawChannel& channel : channels)
      out.push_back(seed_channel(names.network, names.station, channel.number, rate_hz));
    return out;
  }

  double resolution_mps2_;
  MiniseedFile file_;
  std::vector<std::string> names_;
};

/// Makes an export by the ending of its name: .lcmlog (accel_t, as `framewatch replay` reads), .csv
/// and .csv.gz (a record) or .mseed (Steim-2 counts of `resolution_mps2`). Returns nullptr and sets
/// `error` on failure.
std::unique_ptr<RawExport> raw_export(const HistoryArguments& arguments,
                                      const std::vector<RawChannel>& channels, double rate_hz,
                                      double resolution_mps2, std::string& error) {
  const std::string& path = arguments.raw;
  const auto opened = [&](auto out) -> std::unique_ptr<RawExport> {
    if (out->open(path)) return out;
    error = fmt::format("{}: {}", path, out->error());
    return nullptr;
  };
  if (path.ends_with(".lcmlog")) return opened(std::make_unique<LogExport>(channels, rate_hz));
  if (path.ends_with(".mseed"))
    return opened(std::make_unique<SeedExport>(channels, rate_hz, resolution_mps2, arguments));
  return opened(std::make_unique<CsvExport>(channels));
}

constexpr std::int64_t kProgressSamples = 1 << 14;

class RawJob {
 public:
  RawJob(const HistoryArguments& arguments, const HistoryRequest& request,
         std::vector<std::string>& problems)
      : a_(arguments), request_(request), problems_(problems) {}

  void run() {
    (*progress_)("looking for raw samples", 0);
    const std::vector<RawLog> logs =
        raw_logs_between(request_.directory, request_.from_us, request_.to_us);
    // Reads everything once first: an export has all of its channels from the start.
    std::vector<std::string> names;
    double rate_hz = 0, resolution_mps2 = 0;
    std::int64_t samples = 0;
    std::vector<std::string> notes;
    std::string why;
    if (!read_raw_history(logs, request_.from_us, request_.to_us,
                          {[&](const auto& now, double rate) {
                             for (const std::string& name : now)
                               if (std::find(names.begin(), names.end(), name) == names.end())
                                 names.push_back(name);
                             if (rate_hz == 0) rate_hz = rate;
                           },
                           [&](const RawCount& c) {
                             ++samples;
                             if (resolution_mps2 == 0) resolution_mps2 = c.resolution_mps2;
                           }},
                          notes, why))
      return problem(why);
    check_patterns("--channel", a_.channels, names, problems_);
    if (samples == 0) problem("there are no raw samples in that time");
    if (!problems_.empty()) return;
    std::vector<RawChannel> channels;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (is_chosen(a_.channels, names[i])) channels.push_back(placed(names[i], i));
    std::erase_if(names, [&](const std::string& name) { return !is_chosen(a_.channels, name); });
    const auto out = raw_export(a_, channels, rate_hz, resolution_mps2, why);
    if (!out) return problem(why);
    expected_ = samples;
    progress_->part_begins();
    write_raw(logs, names, *out);
  }

 private:
  void problem(std::string message) { problems_.push_back(std::move(message)); }

  /// Returns the LCM address of a channel: from the configuration, otherwise a separate node.
  RawChannel placed(const std::string& name, std::size_t index) const {
    if (request_.config) {
      const auto all = addresses(request_.config->sources);
      for (std::size_t i = 0; i < all.size(); ++i)
        if (request_.config->pipeline.axes[i].name == name) return {name, all[i], i};
    }
    return {name, {"ACCEL", static_cast<std::int32_t>(index), 0}, index};
  }

  void write_raw(const std::vector<RawLog>& logs, const std::vector<std::string>& names,
                 RawExport& out) {
    std::vector<std::optional<std::size_t>> place;  // by channel of the log
    std::int64_t seen = 0, samples = 0, beyond = 0;
    bool good = true;
    std::vector<std::string> notes;
    std::string why;
    const RawVisitor visitor{
        [&](const std::vector<std::string>& now, double) {
          place.assign(now.size(), std::nullopt);
          for (std::size_t i = 0; i < now.size(); ++i)
            if (const auto at = std::find(names.begin(), names.end(), now[i]); at != names.end())
              place[i] = static_cast<std::size_t>(at - names.begin());
        },
        [&](const RawCount& c) {
          if (++seen % kProgressSamples == 0)
            (*progress_)("writing " + a_.raw,
                         static_cast<double>(seen) / static_cast<double>(expected_));
          if (!good || !place[c.channel]) return;
          ++samples;
          beyond += c.count == drivers::kMaxCount || c.count == -drivers::kMaxCount;
          good = out.put(*place[c.channel], c.time_us, c.accel_mps2());
        },
        [&](const drivers::LogEvent& event) { good = good && out.message(event); }};
    const bool read = read_raw_history(logs, request_.from_us, request_.to_us, visitor, notes, why);
    if (!read || !good || !out.close())
      return problem(read ? fmt::format("{}: {}", a_.raw, out.error()) : why);
    progress_.reset();
    std::FILE* const where = a_.raw == drivers::kStandardOutput ? stderr : stdout;
    fmt::print(where, "{}: {} samples of {} channels\n", a_.raw, samples, names.size());
    if (beyond > 0) fmt::print(where, "{} of them exceed the stored range\n", beyond);
    for (const std::string& note : notes) fmt::print(where, "{}\n", printable_lines(note));
    for (const std::string& note : out.notes()) fmt::print(where, "{}\n", printable_lines(note));
  }

  const HistoryArguments& a_;
  const HistoryRequest& request_;
  std::vector<std::string>& problems_;
  std::int64_t expected_ = 0;  ///< total of all channels
  std::optional<ProgressLine> progress_{std::in_place, "history", false};
};

}  // namespace

void export_raw_history(const HistoryArguments& arguments, const HistoryRequest& request,
                        std::vector<std::string>& problems) {
  RawJob(arguments, request, problems).run();
}

}  // namespace framewatch::daemon
