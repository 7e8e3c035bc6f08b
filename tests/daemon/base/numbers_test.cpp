// SPDX-License-Identifier: MIT
#include "daemon/base/numbers.h"

#include <gtest/gtest.h>

#include "daemon/base/html_page.h"

namespace framewatch::daemon {
namespace numbers_test {

TEST(NumberWords, RoundAValueToItsError) {
  EXPECT_EQ(with_error(25, 0.00078), "25.00000 ± 0.00078");
  EXPECT_EQ(with_error(33.9934, 0.0102), "33.993 ± 0.010");
  EXPECT_EQ(with_error(123.4, 17), "123 ± 17");
  EXPECT_EQ(with_error(5, 0), "5.000 ± 0.000");
}

TEST(NumberWords, GiveAChangeInTenthsOfAPercent) {
  EXPECT_EQ(change_with_error(-0.25, 0.00004), "-25.0 ± 0.1");
  EXPECT_EQ(change_with_error(-0.0001, 0.014), "+0.0 ± 1.4");
}

TEST(HtmlTable, AlignsWordsLeft) {
  const std::string table =
      html_table({"element", "what", "size"}, {{"a", "it changed", "-3"}, {"b", "gone", "-"}});
  EXPECT_NE(table.find("<table class=\"short w2\">"), std::string::npos) << table;
}

}  // namespace numbers_test
}  // namespace framewatch::daemon
