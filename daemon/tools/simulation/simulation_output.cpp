// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulation_output.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/config/channel_addresses.h"
#include "drivers/can/bus_load.h"
#include "drivers/can/can_encoder.h"
#include "drivers/can/can_socket.h"
#include "drivers/files/standard_streams.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/records/record_csv_writer.h"

namespace framewatch::daemon {
namespace {

constexpr int kSmallBuffer_bytes = 4096;
constexpr auto kWorthSleeping = std::chrono::milliseconds(1);
/// Opening and closing a CAN socket takes milliseconds. A separate thread does it, so that the
/// nodes are not delayed.
constexpr auto kLookAgain = std::chrono::milliseconds(50);
/// Matches an unused id: the sender reads nothing.
const std::vector<drivers::CanFilter> kNothing{{0x1FFFFFFF, 0x1FFFFFFF, true}};

class CanOutput : public SimulationOutput {
 public:
  CanOutput(const Scenario& s, const std::string& interface, double speed)
      : map_(s.config.can), encoder_(map_), speed_(speed) {
    for (const drivers::CanBusMap& bus : map_.buses)
      interfaces_.push_back(interface.empty() ? bus.interface : interface);
    sockets_.resize(interfaces_.size());
    look_again_.resize(interfaces_.size());
  }

  bool open(std::string& error) {
    for (std::size_t b = 0; b < sockets_.size(); ++b) {
      bool up = false;
      if (!open_bus(b, error)) return false;
      if (drivers::find_interface(interfaces_[b], up) == 0 || !up) {
        error = interfaces_[b] + ": the interface is down";
        return false;
      }
    }
    return true;
  }

  bool put(double time_s, const std::vector<double>& raw) override {
    if (!started_) start_ = Clock::now();
    started_ = true;
    std::vector<double> free_s(sockets_.size(), 0);
    for (const drivers::BusFrame& f : encoder_.instant(raw)) {
      const auto b = static_cast<std::size_t>(f.bus);
      const drivers::CanBusMap& bus = map_.buses[b];
      free_s[b] += drivers::worst_frame_s(f.frame.length, f.frame.extended, f.frame.fd,
                                          bus.bit_rate, bus.data_bit_rate);
      const std::chrono::duration<double> due((time_s + free_s[b]) / speed_);
      const auto at = start_ + std::chrono::duration_cast<Clock::duration>(due);
      if (at - Clock::now() > kWorthSleeping) std::this_thread::sleep_until(at);
      if (!send(b, f.frame)) ++unsent_;
    }
    return true;
  }

  bool close() override {
    if (unsent_ > 0) fmt::print(stderr, "framewatch simulate: {} frames found no bus\n", unsent_);
    return true;
  }
  std::string error() const override { return "CAN refuses to send"; }

 private:
  using Clock = std::chrono::steady_clock;

  bool open_bus(std::size_t b, std::string& error) {
    return sockets_[b].open(interfaces_[b], kSmallBuffer_bytes, kNothing, false, error);
  }

  bool send(std::size_t b, const drivers::CanFrame& frame) {
    constexpr int kTries = 2000;
    constexpr auto kPause = std::chrono::microseconds(500);
    std::string error;
    if (!sockets_[b].is_open()) {
      const Clock::time_point now = Clock::now();
      if (now < look_again_[b]) return false;
      look_again_[b] = now + kLookAgain;
      if (!open_bus(b, error)) return false;
    }
    for (int i = 0; i < kTries; ++i) {
      if (sockets_[b].write(frame)) return true;
      if (errno != ENOBUFS && errno != EAGAIN) break;
      std::this_thread::sleep_for(kPause);
    }
    if (errno != ENETDOWN) sockets_[b] = drivers::CanSocket();
    return false;
  }

  const drivers::CanMap& map_;
  drivers::CanEncoder encoder_;
  double speed_;
  std::vector<std::string> interfaces_;
  std::vector<drivers::CanSocket> sockets_;
  std::vector<Clock::time_point> look_again_;  ///< when to retry a missing interface
  bool started_ = false;
  Clock::time_point start_;
  std::int64_t unsent_ = 0;
};

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
  std::int64_t table_every_;  ///< instants between channel tables; late listeners need the names
  Clock::time_point start_;   ///< time of the first instant
  std::int64_t start_us_ = 0;
  std::int64_t instant_ = 0;
};

class RecordOutput : public SimulationOutput {
 public:
  RecordOutput(const Scenario& s, drivers::Record& record) : record_(record) {
    record_ = {};
    record_.names = axis_names(s.config);
    record_.rate_hz = s.rate_hz;
    record_.accel_mps2.resize(record_.names.size());
    for (const estimator::SensorAxis& axis : s.config.pipeline.axes) {
      record_.headers.emplace_back();
      if (axis.is_force) record_.headers.back().unit = "N";
    }
  }
  bool put(double time_s, const std::vector<double>& raw) override {
    record_.time_s.push_back(time_s);
    for (std::size_t c = 0; c < raw.size(); ++c) record_.accel_mps2[c].push_back(raw[c]);
    return true;
  }
  bool close() override { return true; }
  std::string error() const override { return {}; }

 private:
  drivers::Record& record_;
};

}  // namespace

std::unique_ptr<SimulationOutput> can_output(const Scenario& s, const std::string& interface,
                                             double speed, std::string& error) {
  if (s.config.can.empty()) {
    error = s.config.path + ": no channel has a source on CAN";
    return nullptr;
  }
  if (!interface.empty() && s.config.can.buses.size() > 1) {
    error = "--can names one interface and the configuration has several";
    return nullptr;
  }
  auto out = std::make_unique<CanOutput>(s, interface, speed);
  if (!out->open(error)) return nullptr;
  return out;
}

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

std::unique_ptr<SimulationOutput> record_output(const Scenario& s, drivers::Record& record) {
  return std::make_unique<RecordOutput>(s, record);
}

std::string run_simulation(const Scenario& s, const std::string& name,
                           const std::vector<std::unique_ptr<SimulationOutput>>& outputs,
                           const std::function<void(std::int64_t done)>& step) {
  Simulation simulation(s);
  const std::int64_t count = instants(s);
  for (std::int64_t i = 0; i < count; ++i) {
    const std::vector<double>& raw = simulation.next();
    if (simulation.collapsed())
      return fmt::format("{}: the building collapses at {:.2f} s", name, simulation.time_s());
    for (const auto& output : outputs)
      if (!output->put(simulation.time_s(), raw)) return output->error();
    if (step) step(i + 1);
  }
  for (const auto& output : outputs)
    if (!output->close()) return output->error();
  return {};
}

}  // namespace framewatch::daemon
