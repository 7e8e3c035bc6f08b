// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/base/sqlite_file.h"

namespace framewatch::test {

/// Makes a history and writes rows to it. The test fails if the database refuses a row.
class StoredSummaries {
 public:
  /// Makes the directory and an empty database.
  explicit StoredSummaries(const std::string& directory);

  /// Adds a parameter and returns its id.
  std::int64_t parameter(const std::string& name, const std::string& unit = "N/m");
  /// Adds a period with 100 windows.
  void period(std::int64_t period_s, std::int64_t start_us);
  /// Adds a parameter in such a period; quartiles one percent from the median. observable: of its
  /// 100 windows.
  void value(std::int64_t parameter, std::int64_t period_s, std::int64_t start_us, double median,
             int observable = 100);
  void weather(const std::string& covariate, std::int64_t start_us, double mean);
  /// Adds a raised event.
  void event(std::int64_t id, const std::string& kind, const std::string& place,
             std::int64_t time_us, int severity, const std::string& message);
  void note(std::int64_t id, const std::string& kind, std::int64_t time_us,
            const std::string& comment);
  /// Runs `work` as one transaction, which is fast.
  void together(const std::function<void()>& work);

 private:
  void execute(const std::string& sql);
  daemon::SqliteFile file_;
  std::int64_t parameters_ = 0;
};

}  // namespace framewatch::test
