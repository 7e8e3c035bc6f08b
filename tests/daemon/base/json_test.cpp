// SPDX-License-Identifier: MIT
#include "daemon/base/json.h"

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace json_test {

TEST(JsonText, IsValidForAnyBytes) {
  std::string every;
  for (int i = 0; i < 256; ++i) every += static_cast<char>(i);
  const std::string text = json_text(every);
  EXPECT_TRUE(nlohmann::json::accept(text)) << text;
  for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  EXPECT_EQ(json_text("\"\\é"), "\"\\\"\\\\é\"");
  EXPECT_EQ(json_text("\x7f\xc2\x9b\xff"), "\"\\u007f\\u009b\\ufffd\"");
}

TEST(JsonList, HasNoNumberThatRoundsToInfinity) {
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(json_list(std::vector{1.25, most, -most, 1e300}, "{:.4g}"), "[1.25,null,null,1e+300]");
}

TEST(HtmlText, OpensNoTagAndEndsNoAttribute) {
  EXPECT_EQ(html_text("</td><script>\"&"), "&lt;/td&gt;&lt;script&gt;&quot;&amp;");
}

}  // namespace json_test
}  // namespace framewatch::daemon
