// SPDX-License-Identifier: MIT
#include "daemon/base/printable.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/log.h"

namespace framewatch::daemon {
namespace printable_test {

TEST(Printable, KeepsOrdinaryTextInAnyLanguage) {
  for (const char* text : {"", "a loose sensor, \"F1\" \\n", "größer als 5 µm/s²", "地震", "🏢"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesControlCharacters) {
  EXPECT_EQ(printable("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(printable("\x1b[2J\x07\x7f"), "\\x1b[2J\\x07\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m");                                             // CSI as one character
  EXPECT_EQ(printable("\xe2\x80\xae"), "\\u202e");                     // right to left from here on
  EXPECT_EQ(printable("\xe2\x80\xa8\xef\xbb\xbf"), "\\u2028\\ufeff");  // a line's end, a mark
}

TEST(Printable, QuotesCellsOfCsv) {
  EXPECT_EQ(csv_text("kx_1_y1"), "kx_1_y1");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("say \"a\""), "\"say \"\"a\"\"\"");
  EXPECT_EQ(csv_text("a\nb\x1b[31m"), "a\\nb\\x1b[31m");
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                    // cut
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");           // ESC, too long
  EXPECT_EQ(printable("\xe0\x80\x8a"), "\\xe0\\x80\\x8a");  // a line feed, too long
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a pair
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable("\xc3\xa9\xa9"), "é\\xa9");
}

TEST(Printable, IsBoundedAndIdempotent) {
  EXPECT_EQ(printable("abcdef", 6), "abcdef");
  EXPECT_EQ(printable("abcdefg", 6), "abc...");
  EXPECT_EQ(printable("abc\xc3\xa9\xc3\xa9", 7), "abcé\xc3\xa9");
  EXPECT_EQ(printable("abc\xc3\xa9\xc3\xa9", 6), "abc...");  // no half of a character
  EXPECT_LE(printable(std::string(1'000'000, '\x1b')).size(), kMaxPrinted);
  std::string every;
  for (int i = 0; i < 100'000; ++i) every += static_cast<char>((i * 7919) >> 3);
  const std::string once = printable(every, 1'000'000);
  EXPECT_EQ(printable(once, 1'000'000), once);
  EXPECT_TRUE(std::none_of(once.begin(), once.end(), [](unsigned char c) { return c < 0x20; }));
}

TEST(Printable, KeepsLineBreaksOnRequest) {
  const std::string longer(3 * kMaxPrinted, 'x');
  EXPECT_EQ(printable_lines("a\n" + longer), "a\n" + longer);
  EXPECT_EQ(printable_lines("a\n\x1b"
                            "b\n"),
            "a\n\\x1bb\n");
}

TEST(Log, CannotBeForged) {
  testing::internal::CaptureStderr();
  log(LogLevel::notice,
      "event 1 is acknowledged by me: x\n<0>framewatch: the building falls\x1b[2J");
  RateLimitedLog limited(LogLevel::warning);
  limited(0, "a\nb");
  (void)refuse("run", "no\x1b");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "framewatch: event 1 is acknowledged by me: x\\n<0>framewatch: the building "
            "falls\\x1b[2J\n"
            "framewatch: a\\nb\n"
            "framewatch run: no\\x1b\n");
}

}  // namespace printable_test
}  // namespace framewatch::daemon
