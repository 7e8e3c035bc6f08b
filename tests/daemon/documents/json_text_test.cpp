#include "daemon/documents/json_text.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/documents/html_text.h"

namespace framewatch::daemon {
namespace json_text_test {

TEST(JsonText, IsJsonWhateverTheBytesAre) {
  std::string every;
  for (int i = 0; i < 256; ++i) every += static_cast<char>(i);
  const std::string text = json_text(every);
  EXPECT_TRUE(nlohmann::json::accept(text)) << text;
  for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
  EXPECT_EQ(json_text("\"\\é"), "\"\\\"\\\\é\"");
  EXPECT_EQ(json_text("\x7f\xc2\x9b\xff"), "\"\\u007f\\u009b\\ufffd\"");
}

TEST(HtmlText, NothingOpensATagOrEndsAnAttribute) {
  EXPECT_EQ(html_text("</td><script>\"&"), "&lt;/td&gt;&lt;script&gt;&quot;&amp;");
}

}  // namespace json_text_test
}  // namespace framewatch::daemon
