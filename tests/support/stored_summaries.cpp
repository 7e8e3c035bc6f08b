// SPDX-License-Identifier: MIT
#include "tests/support/stored_summaries.h"

#include <filesystem>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"

namespace framewatch::test {

StoredSummaries::StoredSummaries(const std::string& directory) {
  std::filesystem::create_directories(directory);
  EXPECT_TRUE(file_.open(daemon::summary_file(directory))) << file_.error();
  EXPECT_EQ(daemon::upgrade(file_, daemon::history_schema()), "");
}

void StoredSummaries::execute(const std::string& sql) {
  EXPECT_TRUE(file_.execute(sql)) << file_.error() << "\n" << sql;
}

std::int64_t StoredSummaries::parameter(const std::string& name, const std::string& unit) {
  execute(fmt::format("INSERT INTO parameter VALUES ({}, '{}', '{}', 0, 1)", ++parameters_, name,
                      unit));
  return parameters_;
}

void StoredSummaries::period(std::int64_t period_s, std::int64_t start_us) {
  execute(fmt::format("INSERT INTO period VALUES ({}, {}, 100, {}, 0)", period_s, start_us,
                      start_us + 1'000'000 * period_s - 1));
}

void StoredSummaries::value(std::int64_t parameter, std::int64_t period_s, std::int64_t start_us,
                            double median, int observable) {
  const std::string values =
      observable == 0 ? "NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0"
                      : fmt::format("{0}, {1}, {2}, {2}, {2}, {0}, {3}, {3}, {3}, 0, 10", median,
                                    0.001 * median, 0.99 * median, 1.01 * median);
  execute(fmt::format("INSERT INTO summary VALUES ({}, {}, {}, {}, {})", parameter, period_s,
                      start_us, observable, values));
}

void StoredSummaries::weather(const std::string& covariate, std::int64_t start_us, double mean) {
  execute(fmt::format("INSERT OR IGNORE INTO covariate (name) VALUES ('{}')", covariate));
  execute(
      fmt::format("INSERT INTO weather VALUES ((SELECT id FROM covariate WHERE name = '{}'), "
                  "{}, 6, {}, {}, {}, {})",
                  covariate, start_us, mean, mean - 1, mean + 1, start_us + 1));
}

void StoredSummaries::event(std::int64_t id, const std::string& kind, const std::string& place,
                            std::int64_t time_us, int severity, const std::string& message) {
  execute(fmt::format(
      "INSERT INTO event VALUES ('{}', {}, {}, 1, {}, {}, '{}', NULL, NULL, '', '{}', '')", kind,
      id, time_us, time_us, severity, place, message));
}

void StoredSummaries::note(std::int64_t id, const std::string& kind, std::int64_t time_us,
                           const std::string& comment) {
  execute(fmt::format("INSERT INTO acknowledgement VALUES ('{}', {}, {}, 'kx_1_y1', 'Ada', '{}')",
                      kind, id, time_us, comment));
}

void StoredSummaries::together(const std::function<void()>& work) {
  EXPECT_TRUE(file_.transaction([&] {
    work();
    return true;
  })) << file_.error();
}

}  // namespace framewatch::test
