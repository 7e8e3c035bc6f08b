// SPDX-License-Identifier: MIT
#include "tests/guest/inner/guest.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include <gtest/gtest.h>

#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "drivers/can/can_map.h"
#include "drivers/lcm/accel_codec.h"

namespace framewatch::test {

daemon::Config example_on(const std::string& name, const std::string& interface) {
  std::vector<daemon::ConfigProblem> problems;
  auto config =
      daemon::load_config(FRAMEWATCH_SOURCE_DIR "/configs/can/" + name + ".toml", problems);
  if (!config) throw std::runtime_error(problems.front().message);
  config->can.buses.at(0).interface = interface;
  return *std::move(config);
}

void shell(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

Process::Process(std::vector<std::string> arguments) : pid_(::fork()) {
  if (pid_ != 0) return;
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

bool Process::ended() {
  if (!ended_) {
    int status = 0;
    ended_ = ::waitpid(pid_, &status, WNOHANG) == pid_;
    if (ended_) {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
  }
  return ended_;
}

Process::~Process() {
  if (!ended_) ::waitpid(pid_, nullptr, 0);
}

namespace {

/// Returns a value as CanIntake decodes it after CanEncoder encoded it.
double quantized(const drivers::CanMap& map, int axis, double value) {
  for (const drivers::CanNodeMap& node : map.nodes)
    for (const drivers::CanMessageMap& m : node.messages)
      for (const drivers::CanReading& r : m.readings) {
        if (r.axis != axis) continue;
        std::array<std::uint8_t, 64> data{};
        put_physical(r.field, value, data);
        return physical(r.field, data);
      }
  return value;
}

}  // namespace

std::vector<estimator::WindowEstimate> estimates_over_lcm(const std::string& path, double seconds) {
  std::vector<daemon::ConfigProblem> problems;
  auto scenario = daemon::load_scenario(path, problems);
  EXPECT_TRUE(scenario);
  scenario->duration_s = seconds;
  const drivers::CanMap map = scenario->config.can;
  daemon::Config config = scenario->config;
  config.can = {};
  std::vector<std::string> names;
  std::vector<drivers::AxisAddress> addresses;
  for (std::size_t a = 0; a < config.sources.size(); ++a) {
    config.sources[a] = {"ACCEL", static_cast<int>(a), 0};
    names.push_back(config.pipeline.axes[a].name);
    addresses.push_back({"ACCEL", static_cast<int>(a), 0});
  }
  struct : daemon::EstimationListener {
    void on_estimate(const estimator::WindowEstimate& e) override { estimates.push_back(e); }
    std::vector<estimator::WindowEstimate> estimates;
  } heard;
  daemon::Estimation estimation(
      config, [](std::int64_t, const std::string&, const std::vector<std::uint8_t>&) {}, &heard);
  drivers::AccelMessages messages(names, addresses, 100);
  daemon::Simulation simulation(*scenario);
  for (std::int64_t k = 0; k < daemon::instants(*scenario); ++k) {
    std::vector<double> values = simulation.next();
    for (std::size_t a = 0; a < values.size(); ++a)
      values[a] = quantized(map, static_cast<int>(a), values[a]);
    for (const drivers::Message& m : messages.samples(10'000 * k, values))
      estimation.message(m.channel, m.bytes.data(), m.bytes.size());
  }
  estimation.finish();
  return heard.estimates;
}

namespace {

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

}  // namespace

std::size_t different(const std::vector<estimator::WindowEstimate>& a,
                      const std::vector<estimator::WindowEstimate>& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    count += !same_bytes(a[i].value, b[i].value) || !same_bytes(a[i].std_error, b[i].std_error) ||
             a[i].reason != b[i].reason;
  return count;
}

LiveBuses::LiveBuses(const daemon::Config& config)
    : estimation(
          config, [](std::int64_t, const std::string&, const std::vector<std::uint8_t>&) {}, this),
      source(config.can, false,
             [this](int bus, const drivers::CanFrame& frame) { estimation.frame(bus, frame); }) {
  for (const std::string& note : source.open()) ADD_FAILURE() << note;
}

void LiveBuses::run(const std::function<bool()>& done) {
  using Clock = std::chrono::steady_clock;
  constexpr int kPoll_ms = 20;
  Clock::time_point end = Clock::time_point::max();
  while (Clock::now() < end) {
    std::vector<pollfd> waiting;
    source.descriptors(waiting);
    ::poll(waiting.data(), waiting.size(), kPoll_ms);
    source.handle(
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch())
            .count());
    if (end == Clock::time_point::max() && done())
      end = Clock::now() + std::chrono::milliseconds(500);
  }
  estimation.finish();
}

}  // namespace framewatch::test
