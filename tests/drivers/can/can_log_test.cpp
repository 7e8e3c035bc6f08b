// SPDX-License-Identifier: MIT
#include "drivers/can/can_log.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/data.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace can_log_test {

CanFrame good(const std::string& line) {
  CanFrame frame;
  std::string_view interface;
  std::string rule;
  EXPECT_TRUE(parse_candump_line(line, frame, interface, rule)) << line << ": " << rule;
  return frame;
}

TEST(CandumpLine, ReadsBackEveryKindOfFrame) {
  for (const char* line :
       {"(1631416514.717133) can0 0D2#0000FFFF10000000", "(0000000000.000001) vcan10 18FEDC33#",
        "(0000000001.000000) c 7FF#R", "(0000000001.000000) c 7FF#R8",
        "(0000000001.000000) can1 20000004#0004000000006061",
        "(0000000001.000000) can1 123##1112233445566778899AABBCC",
        "(0000000001.000000) can1 12345678##0"}) {
    const std::string text = line;
    const std::size_t from = text.find(' ') + 1;
    EXPECT_EQ(candump_line(good(text), text.substr(from, text.find(' ', from) - from)), text);
  }
  const CanFrame fd = good("(1.000000) can1 123##1112233445566778899AABBCC");
  EXPECT_TRUE(fd.fd && fd.bit_rate_switch);
  EXPECT_EQ(fd.length, 12);
  const CanFrame error = good("(1.000000) can1 20000044#0004000000006061");
  EXPECT_TRUE(error.error);
  EXPECT_EQ(error.id, 0x44u);
}

TEST(CandumpLine, RefusesMalformedLines) {
  for (const char* line : {"",
                           "(",
                           "()",
                           "(1.5) can0 1#",
                           "(1.000000 can0 123#",
                           "(x.000000) can0 123#",
                           "(1.000000)  ",
                           "(1.000000) can0",
                           "(1.000000) can0 12#00",
                           "(1.000000) can0 800#00",
                           "(1.000000) can0 123#0",
                           "(1.000000) can0 123#001122334455667788",
                           "(1.000000) can0 123##",
                           "(1.000000) can0 123##g",
                           "(1.000000) can0 123##0112233445566778899",
                           "(1.000000) can0 123#zz",
                           "(1.000000) can0 123#R9",
                           "(1.000000) can0 FFFFFFFF#",
                           "(1.000000) can0 123#00 and more",
                           "(1.000000) averyveryverylongname 123#00",
                           "(-1.000000) can0 123#",
                           "(99999999999.000000) can0 123#"}) {
    CanFrame frame;
    std::string_view interface;
    std::string rule;
    EXPECT_FALSE(parse_candump_line(line, frame, interface, rule)) << line;
    EXPECT_FALSE(rule.empty());
  }
}

TEST(CanLog, CopiesARealLogByteForByte) {
  const auto path = test::data_path("can_real_vehicle_accel/can_sample.log");
  if (!path) GTEST_SKIP() << "no can_real_vehicle_accel in FRAMEWATCH_DATA";
  const test::TemporaryDirectory directory;
  CanLogWriter writer;
  ASSERT_TRUE(writer.open(directory.path("again.log")));
  std::vector<Problem> problems;
  std::int64_t frames = 0;
  EXPECT_TRUE(looks_like_candump(*path));
  EXPECT_TRUE(read_candump(
      *path,
      [&](const CanFrame& frame, std::string_view interface) {
        ++frames;
        ASSERT_TRUE(writer.write(frame, interface));
      },
      problems));
  ASSERT_TRUE(writer.close());
  EXPECT_EQ(frames, 82558);
  EXPECT_EQ(test::read_file(directory.path("again.log")), test::read_file(*path));
}

TEST(CanLog, ReportsMalformedLines) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("a.log"),
                   "(1.000000) can0 123#00\nrubbish\n(1.000001) can0 123#0");
  std::vector<Problem> problems;
  int frames = 0;
  EXPECT_FALSE(read_candump(
      directory.path("a.log"), [&](const CanFrame&, std::string_view) { ++frames; }, problems));
  EXPECT_EQ(frames, 1);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_TRUE(problems[0].where.ends_with("a.log:2"));
  EXPECT_TRUE(problems[1].where.ends_with("a.log:3"));
}

}  // namespace can_log_test
}  // namespace framewatch::drivers
