// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "tests/support/temporary.h"

namespace framewatch::test {

/// Returns the text with the first `what` replaced. Fails the test if `what` is not there.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

/// Writes texts to a file and reads it as a record.
class StationFileTest : public testing::Test {
 protected:
  std::optional<drivers::Record> read(const std::string& text,
                                      const drivers::RecordOptions& options = {}) {
    write_file(path_, text);
    problems_.clear();
    return drivers::read_record(path_, options, problems_);
  }
  /// The first problem must be at the line and name the rule. line: 0: of the file; -1: any.
  void expect_refused(const std::string& text, int line, const std::string& rule,
                      const drivers::RecordOptions& options = {}) {
    SCOPED_TRACE(rule);
    EXPECT_FALSE(read(text, options));
    ASSERT_FALSE(problems_.empty());
    const std::string& message = problems_[0].message;
    if (line >= 0) {
      EXPECT_EQ(problems_[0].where, line > 0 ? fmt::format("{}:{}", path_, line) : path_)
          << message;
    }
    EXPECT_NE(message.find(rule), std::string::npos) << message;
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_.path("station.dat");
  std::vector<drivers::Problem> problems_;
};

}  // namespace framewatch::test
