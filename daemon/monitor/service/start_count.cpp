// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/start_count.h"

#include <cstdint>
#include <sstream>

#include <fmt/core.h>

#include "drivers/files/input_file.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kMaxBytes = 4096;

std::string file_of(const std::string& state_path) {
  return state_path + ".starts";
}

std::string store(const std::string& state_path, const StartCount& count, bool running) {
  return drivers::write_text_file(
      file_of(state_path), fmt::format("starts {}\nunclean_starts {}\nrunning {}\n", count.starts,
                                       count.unclean_starts, running ? 1 : 0));
}

}  // namespace

StartCount count_start(const std::string& state_path, std::string& problem) {
  StartCount count;
  std::int64_t running = 0;
  std::string unread;
  std::istringstream file(
      drivers::read_whole_file(file_of(state_path), kMaxBytes, unread).value_or(""));
  std::string key;
  for (std::int64_t value = 0; file >> key >> value;) {
    if (key == "starts") count.starts = value;
    if (key == "unclean_starts") count.unclean_starts = value;
    if (key == "running") running = value;
  }
  ++count.starts;
  if (running != 0) ++count.unclean_starts;
  problem = store(state_path, count, true);
  return count;
}

std::string count_clean_stop(const std::string& state_path, const StartCount& count) {
  return store(state_path, count, false);
}

}  // namespace framewatch::daemon
