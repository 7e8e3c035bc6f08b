#include "daemon/tools/simulation/simulation_output.h"
#include "daemon/config/channel_addresses.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "daemon/base/clocks.h"
#include "daemon/config/axis_names.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record_csv_writer.h"

namespace framewatch::daemon {
namespace {

std::int64_t microseconds(double time_s) {
  return std::llround(time_s * 1e6);
}

class CsvOutput : public SimulationOutput {
 public:
  bool open(const Scenario& s, const std::string& path) {
    return writer_.open(path, axis_names(s.config));
  }
  bool put(double time_s, const std::vector<double>& raw) override {
    return writer_.write(time_s, raw);
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  drivers::RecordCsvWriter writer_;
};

class LogOutput : public SimulationOutput {
 public:
  explicit LogOutput(const Scenario& s) : messages_(accel_messages(s.config, s.rate_hz)) {}
  bool open(const std::string& path) { return writer_.open(path) && write(0, messages_.tables(0)); }
  bool put(double time_s, const std::vector<double>& raw) override {
    const std::int64_t time_us = microseconds(time_s);
    return write(time_us, messages_.samples(time_us, raw));
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  bool write(std::int64_t time_us, const std::vector<drivers::Message>& all) {
    return std::all_of(all.begin(), all.end(), [&](const drivers::Message& m) {
      return writer_.write(time_us, m.channel, m.bytes.data(), m.bytes.size());
    });
  }

  drivers::AccelMessages messages_;
  drivers::LcmLogWriter writer_;
};

class LiveOutput : public SimulationOutput {
 public:
  LiveOutput(const Scenario& s, lcm::LCM& lcm, double speed)
      : lcm_(lcm),
        messages_(accel_messages(s.config, s.rate_hz)),
        speed_(speed),
        table_every_(std::llround(s.rate_hz)) {}

  bool put(double time_s, const std::vector<double>& raw) override {
    if (instant_ == 0) start();
    const std::chrono::duration<double> since_start(time_s / speed_);
    std::this_thread::sleep_until(start_ +
                                  std::chrono::duration_cast<Clock::duration>(since_start));
    const std::int64_t time_us = start_us_ + microseconds(time_s);
    if (instant_++ % table_every_ == 0 && !publish(messages_.tables(time_us))) return false;
    return publish(messages_.samples(time_us, raw));
  }
  bool close() override { return true; }
  std::string error() const override { return "LCM refuses to send"; }

 private:
  using Clock = std::chrono::steady_clock;

  void start() {
    start_ = Clock::now();
    start_us_ = host_clock_us();
  }

  bool publish(const std::vector<drivers::Message>& all) {
    return std::all_of(all.begin(), all.end(), [&](const drivers::Message& m) {
      return lcm_.publish(m.channel, m.bytes.data(), static_cast<unsigned>(m.bytes.size())) == 0;
    });
  }

  lcm::LCM& lcm_;
  drivers::AccelMessages messages_;
  double speed_;
  std::int64_t table_every_;  ///< instants; so that a late listener learns the names, too
  Clock::time_point start_;   ///< of the first instant
  std::int64_t start_us_ = 0;
  std::int64_t instant_ = 0;
};

}  // namespace

std::unique_ptr<SimulationOutput> file_output(const Scenario& s, const std::string& path,
                                              std::string& error) {
  if (path == drivers::kStandardOutput || path.ends_with(".csv") || path.ends_with(".csv.gz")) {
    auto out = std::make_unique<CsvOutput>();
    if (out->open(s, path)) return out;
    error = out->error();
  } else if (path.ends_with(".lcmlog")) {
    auto out = std::make_unique<LogOutput>(s);
    if (out->open(path)) return out;
    error = out->error();
  } else {
    error = "the name must end in .csv, .csv.gz or .lcmlog, or be - (standard output, CSV)";
  }
  return nullptr;
}

std::unique_ptr<SimulationOutput> live_output(const Scenario& s, lcm::LCM& lcm, double speed) {
  return std::make_unique<LiveOutput>(s, lcm, speed);
}

}  // namespace framewatch::daemon
