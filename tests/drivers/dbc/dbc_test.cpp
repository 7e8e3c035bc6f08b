// SPDX-License-Identifier: MIT
#include "drivers/dbc/dbc.h"

#include <chrono>
#include <random>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace dbc_test {

constexpr int kMutations = 3000;

const std::string kGood = R"(VERSION "1"

NS_ :
    CM_
    BA_DEF_
    VAL_

BS_:

BU_: Node Host

BO_ 1409 Raw: 8 Node
 SG_ AccX : 0|16@1- (0.001,0) [-32|32] "m/s^2" Host
 SG_ AccY : 16|16@1- (0.001,0) [-32|32] "m/s^2"  Host,Other
 SG_ AccZ : 32|16@1- (0.001,0) [-32|32] "m/s^2" Vector__XXX
 SG_ Count : 48|16@1+ (1,0) [0|65535] "" Host

BO_ 52 Xsens: 6 Node
 SG_ X : 7|16@0- (0.00390625,0) [0|0] "m/s^2" Host
 SG_ Y : 23|16@0- (0.00390625,0) [0|0] "m/s^2" Host

BO_ 2364550528 Accel: 8 Vector__XXX
 SG_ Lat : 0|16@1+ (0.01,-320) [-320|322.55] "m/s²" Host

BO_ 80 Multi: 8 Node
 SG_ Kind M : 0|8@1+ (1,0) [0|255] "" Host
 SG_ A m1 : 8|16@1- (1,0) [0|0] "" Host
 SG_ B m2 : 8|16@1- (1,0) [0|0] "" Host
 SG_ F : 32|32@1- (1,0) [0|0] "" Host

CM_ SG_ 1409 AccX "a comment
over lines; with \"quotes\" and BO_ 1 X: 8 Y";
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 1409 10;
VAL_ 80 Kind 1 "a" 2 "b" ;
SIG_VALTYPE_ 80 F : 1;
)";

Dbc good(const std::string& text) {
  std::vector<Problem> problems;
  const std::optional<Dbc> dbc = parse_dbc("a.dbc", text, problems);
  for (const Problem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
  return dbc.value_or(Dbc{});
}

/// Returns every problem as "where: message".
std::string bad(const std::string& text) {
  std::vector<Problem> problems;
  EXPECT_FALSE(parse_dbc("a.dbc", text, problems));
  std::string all;
  for (const Problem& p : problems) all += p.where + ": " + p.message + "\n";
  return all;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(Dbc, ReadsMessagesAndSignals) {
  const Dbc dbc = good(kGood);
  ASSERT_EQ(dbc.messages.size(), 4u);
  const DbcMessage& raw = dbc.messages[0];
  EXPECT_EQ(raw.id, 1409u);
  EXPECT_FALSE(raw.extended);
  EXPECT_DOUBLE_EQ(raw.cycle_s, 0.01);
  ASSERT_EQ(raw.signals.size(), 4u);
  EXPECT_TRUE(raw.signals[0].field.is_signed);
  EXPECT_DOUBLE_EQ(raw.signals[0].field.factor, 0.001);
  const DbcMessage& accel = *dbc.find("Accel");
  EXPECT_TRUE(accel.extended);
  EXPECT_EQ(accel.id, 0x0CF02D80u);
  EXPECT_FALSE(dbc.find("Xsens")->signals[0].field.little_endian);
  const DbcMessage& multi = *dbc.find("Multi");
  EXPECT_EQ(multi.multiplexor()->name, "Kind");
  EXPECT_EQ(multi.find("B")->multiplexed_by, 2);
  EXPECT_EQ(multi.find("F")->field.value, CanValue::float32);
}

TEST(Dbc, AcceptsByteOrderMarkCarriageReturnsAndLatin1) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : replaced(kGood, "\xC2\xB2", "\xB2"))
    text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(good(text).messages.size(), 4u);
}

TEST(Dbc, ReportsEveryBrokenRuleWithItsLine) {
  const auto contains = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  contains(bad(replaced(kGood, "16|16@1- (0.001", "8|16@1- (0.001")),
           "a.dbc:14: signal AccY overlaps AccX (line 13)");
  contains(bad(replaced(kGood, "48|16@1+", "56|16@1+")), "a.dbc:16: signal Count: 16 bits");
  contains(bad(replaced(kGood, "Kind M :", "Kind :")), "A is multiplexed and Multi has no");
  contains(bad(replaced(kGood, " F :", " F M :")), "two multiplexors, Kind and F");
  contains(bad(replaced(kGood, "B m2", "B m300")), "has 8 bits and is never 300");
  contains(bad(replaced(kGood, "B m2", "B m1")), "signal B overlaps A");
  contains(bad(replaced(kGood, "B m2", "B mx")), "expected M, m<number> or a colon");
  contains(bad(replaced(kGood, "(0.001,0)", "(0,0)")), "factor must be finite and not 0");
  contains(bad(replaced(kGood, "(0.001,0)", "(nan,0)")), "a.dbc:13");
  contains(bad(replaced(kGood, "@1-", "@2-")), "a.dbc:13: signal AccX: expected start|bits");
  contains(bad(replaced(kGood, "32|32@1-", "32|16@1-")), "is floating and has 16 bits, not 32");
  contains(bad(replaced(kGood, "BO_ 52", "BO_ 1409")), "Xsens has the id of Raw (line 12)");
  contains(bad(replaced(kGood, " Xsens:", " Raw:")), "Raw is the name of another message");
  contains(bad(replaced(kGood, "BO_ 52", "BO_ 2048")), "2048 of Xsens is not a valid 11-bit id");
  contains(bad(replaced(kGood, "Raw: 8", "Raw: 9")), "no CAN frame has 9 bytes");
  contains(bad(replaced(kGood, "AccY", "AccX")), "Raw has signal AccX already (line 13)");
  contains(bad(replaced(kGood, "BO_ 52", "B0_ 52")), "unknown statement B0_");
  contains(bad(replaced(kGood, "F : 1;", "G : 1;")), "message 80 has no signal G");
  contains(bad(replaced(kGood, "1 \"a\" 2 \"b\" ;", "1 \"a")), "VAL_ does not end");
  contains(bad(" SG_ A : 0|8@1+ (1,0) [0|0] \"\" X\n"), "a.dbc:1: SG_ without a BO_");
  contains(bad(std::string("VERSION \"\0\"", 11)), "bytes of value 0");
}

TEST(Dbc, ListsAtMostTwentyProblems) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "NONSENSE_ 1\n";
  std::vector<Problem> problems;
  EXPECT_FALSE(parse_dbc("a.dbc", text, problems));
  EXPECT_EQ(problems.size(), 21u);
}

TEST(Dbc, SurvivesDamagedFiles) {
  std::mt19937 random(5);
  int read = 0;
  for (int i = 0; i < kMutations; ++i) {
    std::string text = kGood;
    for (unsigned n = random() % 4 + 1; n > 0; --n) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, random() % 40);
          break;
        case 2:
          text.insert(at, text.substr(random() % text.size(), random() % 60));
          break;
        default:
          text.insert(at, std::to_string(random()) + std::to_string(random()));
      }
    }
    std::vector<Problem> problems;
    const auto dbc = parse_dbc("a.dbc", text, problems);
    EXPECT_EQ(dbc.has_value(), problems.empty());
    if (!dbc) continue;
    ++read;
    for (const DbcMessage& m : dbc->messages)
      for (const DbcSignal& s : m.signals) ASSERT_TRUE(fits(s.field, m.length));
  }
  EXPECT_GT(read, kMutations / 100);
  EXPECT_LT(read, kMutations);
}

TEST(Dbc, ManySignalsTakeSeconds) {
  constexpr int kSignals = 100'000;
  std::string text = kGood + "\nBO_ 99 Many: 8 Node\n SG_ Kind M : 0|32@1+ (1,0) [0|0] \"\" Host\n";
  for (int i = 0; i < kSignals; ++i)
    text += fmt::format(" SG_ S{} m{} : 32|32@1- (1,0) [0|0] \"\" Host\n", i, i);
  for (int i = 0; i < kSignals; ++i) text += fmt::format("SIG_VALTYPE_ 99 S{} : 1;\n", i);
  const auto start = std::chrono::steady_clock::now();
  std::vector<Problem> problems;
  const auto dbc = parse_dbc("a.dbc", text, problems);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_TRUE(dbc) << problems.at(0).message;
  EXPECT_EQ(dbc->find("Many")->signals.size(), static_cast<std::size_t>(kSignals) + 1);
  EXPECT_EQ(dbc->find("Many")->signals.back().field.value, CanValue::float32);
  EXPECT_LT(took.count(), 30);  // measured 3 s in Debug; comparing all pairs took minutes
}

}  // namespace dbc_test
}  // namespace framewatch::drivers
