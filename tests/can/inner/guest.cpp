#include "tests/can/inner/guest.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

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

LiveBuses::LiveBuses(const daemon::Config& config)
    : estimation(
          config, [](std::int64_t, const std::string&, const std::vector<std::uint8_t>&) {},
          [this](const WindowEstimate& e) { estimates.push_back(e); }),
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
