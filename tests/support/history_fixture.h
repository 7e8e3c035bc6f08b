// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/history/raw_history_reader.h"

namespace framewatch::test {

/// Returns the two-story table with a history in `directory`, with periods of 1, 2 and 4 s.
daemon::Config table_with_history(const std::string& directory);

/// Returns every sample of a history between two times.
std::vector<daemon::RawCount> raw_counts(const std::string& directory,
                                         std::int64_t from_us = INT64_MIN / 2,
                                         std::int64_t to_us = INT64_MAX / 2);

/// Returns true if the condition becomes true within `limit`.
template <typename Condition>
bool comes_true(Condition condition, std::chrono::milliseconds limit) {
  for (const auto until = std::chrono::steady_clock::now() + limit;
       std::chrono::steady_clock::now() < until;
       std::this_thread::sleep_for(std::chrono::milliseconds(10)))
    if (condition()) return true;
  return condition();
}

}  // namespace framewatch::test
