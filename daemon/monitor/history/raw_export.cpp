// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/raw_export.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/miniseed_file.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/standard_streams.h"
#include "drivers/records/record_csv_writer.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

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
    if (time_us >= next_table_us_ || time_us < next_table_us_ - 2 * kSecond_us) {
      next_table_us_ = time_us + kSecond_us;
      for (const drivers::Message& m : tables_.tables(time_us))
        if (!log_.write(time_us, m.channel, m.bytes.data(), m.bytes.size())) return false;
    }
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
  std::int64_t next_table_us_ = INT64_MIN / 2;
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
             const SeedNames& names)
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
                                                double rate_hz, const SeedNames& names) {
    std::vector<SeedChannel> out;
    for (const RawChannel& channel : channels)
      out.push_back(seed_channel(names.network, names.station, channel.number, rate_hz));
    return out;
  }

  double resolution_mps2_;
  MiniseedFile file_;
  std::vector<std::string> names_;
};

}  // namespace

std::unique_ptr<RawExport> raw_export(const std::string& path,
                                      const std::vector<RawChannel>& channels, double rate_hz,
                                      double resolution_mps2, const SeedNames& names,
                                      std::string& error) {
  const auto opened = [&](auto out) -> std::unique_ptr<RawExport> {
    if (out->open(path)) return out;
    error = fmt::format("{}: {}", path, out->error());
    return nullptr;
  };
  if (path.ends_with(".lcmlog")) return opened(std::make_unique<LogExport>(channels, rate_hz));
  if (path.ends_with(".mseed"))
    return opened(std::make_unique<SeedExport>(channels, rate_hz, resolution_mps2, names));
  return opened(std::make_unique<CsvExport>(channels));
}

std::string problem_of_raw_name(const std::string& path) {
  if (path == drivers::kStandardOutput) return {};
  for (const char* ending : {".lcmlog", ".csv", ".csv.gz", ".mseed"})
    if (path.ends_with(ending)) return {};
  return path + ": the name for raw samples must end in .lcmlog, .csv, .csv.gz or .mseed";
}

}  // namespace framewatch::daemon
