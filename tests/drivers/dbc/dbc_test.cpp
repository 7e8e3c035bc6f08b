// SPDX-License-Identifier: MIT
#include "drivers/dbc/dbc.h"

#include <algorithm>
#include <array>
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

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

/// Returns a file that can be parsed.
Dbc parsed(const std::string& text) {
  std::vector<Problem> problems;
  const std::optional<Dbc> dbc = parse_dbc("a.dbc", text, problems);
  for (const Problem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
  return dbc.value_or(Dbc{});
}

/// Returns every problem, and every rule that a message breaks, as "where: message".
std::string bad(const std::string& text) {
  std::vector<Problem> problems;
  const std::optional<Dbc> dbc = parse_dbc("a.dbc", text, problems);
  EXPECT_EQ(dbc.has_value(), problems.empty());
  std::string all;
  for (const Problem& p : problems) all += p.where + ": " + p.message + "\n";
  for (const DbcMessage& m : dbc.value_or(Dbc{}).messages)
    for (const DbcRule& rule : broken_rules(m))
      all += fmt::format("a.dbc:{}: {}\n", rule.line, rule.message);
  return all;
}

/// Returns a file without any problem.
Dbc good(const std::string& text) {
  EXPECT_EQ(bad(text), "");
  return parsed(text);
}

/// Returns the values of a message's signals that are in a frame, as "A=1 B=-2 ".
std::string decoded(const Dbc& dbc, const std::string& message,
                    const std::array<std::uint8_t, 8>& data) {
  const DbcMessage& m = *dbc.find(message);
  std::string out;
  for (const DbcSignal& s : m.signals) {
    const std::vector<CanSwitch> switches = switches_of(m, s);
    if (std::all_of(switches.begin(), switches.end(),
                    [&](const CanSwitch& multiplexor) { return is_on(multiplexor, data); }))
      out += fmt::format("{}={:g} ", s.name, physical(s.field, data));
  }
  return out;
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
  EXPECT_EQ(multi.find("B")->multiplexor, "Kind");
  EXPECT_EQ(multi.find("B")->present_at, std::vector<ValueRange>({{2, 2}}));
  EXPECT_EQ(multi.find("F")->field.value, CanValue::float32);
}

TEST(Dbc, AcceptsByteOrderMarkCarriageReturnsAndLatin1) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : replaced(kGood, "\xC2\xB2", "\xB2"))
    text += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(good(text).messages.size(), 4u);
}

/// Multiplexors of multiplexors: Deep is in a frame with Page 2 and Sub 3 to 5 or 7, whatever else
/// the number after m suggests. The example of cantools' issue 184 is of the same form.
const std::string kExtended = R"(BU_: A
BO_ 80 Multi: 8 A
 SG_ Page M : 0|8@1+ (1,0) [0|0] "" A
 SG_ Sub m2M : 8|8@1+ (1,0) [0|0] "" A
 SG_ Deep m3 : 16|16@1- (1,0) [0|0] "" A
 SG_ Flat m1 : 16|16@1- (1,0) [0|0] "" A
 SG_ Other m6 : 16|8@1- (1,0) [0|0] "" A
 SG_ Always : 56|8@1- (1,0) [0|0] "" A
SG_MUL_VAL_ 80 Sub Page 2-2;
SG_MUL_VAL_ 80 Deep Sub 3-5,
   7-7;
SG_MUL_VAL_ 80 Flat Page 0-1;
SG_MUL_VAL_ 80 Other Sub 6-6;
)";

TEST(Dbc, FollowsMultiplexorsOfMultiplexors) {
  const Dbc dbc = good(kExtended);
  EXPECT_EQ(decoded(dbc, "Multi", {2, 3, 0xFE, 0xFF, 0, 0, 0, 9}),
            "Page=2 Sub=3 Deep=-2 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {2, 5, 1, 0, 0, 0, 0, 9}), "Page=2 Sub=5 Deep=1 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {2, 7, 1, 0, 0, 0, 0, 9}), "Page=2 Sub=7 Deep=1 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {2, 6, 1, 0, 0, 0, 0, 9}), "Page=2 Sub=6 Other=1 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {2, 8, 1, 0, 0, 0, 0, 9}), "Page=2 Sub=8 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {1, 3, 1, 0, 0, 0, 0, 9}), "Page=1 Flat=1 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {0, 3, 1, 0, 0, 0, 0, 9}), "Page=0 Flat=1 Always=9 ");
  EXPECT_EQ(decoded(dbc, "Multi", {3, 3, 1, 0, 0, 0, 0, 9}), "Page=3 Always=9 ");
}

TEST(Dbc, ReadsStatementsOverSeveralLinesAndRemarks) {
  const Dbc dbc = good(R"(// a remark
BU_: A // another one; with a semicolon
  B
BO_ 80
 Multi: 8
  A // sends it
 SG_ X : 0|16@1- // of a node
   (0.5,0) [0|0]
   "m/s^2" A,
   B
 SG_ Y : 16|16@1- (1,0) [0|0] "m//s" A B
BA_ "GenMsgCycleTime"
  BO_ 80 20;
SIG_VALTYPE_ 80 Y :
  0;
)");
  ASSERT_EQ(dbc.messages.size(), 1u);
  EXPECT_DOUBLE_EQ(dbc.messages[0].cycle_s, 0.02);
  EXPECT_EQ(dbc.messages[0].line, 4);
  EXPECT_EQ(decoded(dbc, "Multi", {4, 0, 3, 0, 0, 0, 0, 0}), "X=2 Y=3 ");
  EXPECT_EQ(dbc.find("Multi")->find("Y")->unit, "m//s");
}

TEST(Dbc, TellsDamagedLinesBetweenSignals) {
  const std::string x = " SG_ X : 0|16@1- (1,0) [0|0] \"\" A\n",
                    y = " SG_ Y : 16|8@1- (1,0) [0|0] \"\"\n";
  const auto with = [&](const std::string& line) {
    return bad("BU_: A\nBO_ 80 Multi: 8 A\n" + y + line + x);
  };
  EXPECT_EQ(with(""), "");
  for (const char* line : {"B0_ 52 Xsens: 6 Node\n", "5G_ Z : 0|8@1+ (1,0) [0|0] \"\" A\n", "; \n",
                           " SG_ Z : 24|8@1+ (1,0) [0|0]\n", "BO_ 81 Cut: 8\n"})
    EXPECT_NE(with(line), "") << line;
}

TEST(Dbc, PassesOverSignalsWithoutAMessage) {
  const Dbc dbc = good(kGood + R"(
BO_ 1073741824 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX
 SG_ Spare : 0|8@1+ (1,0) [0|0] "" Vector__XXX
 SG_ Spare2 : 0|8@1+ (1,0)
   [0|0] "" Vector__XXX
SIG_VALTYPE_ 1073741824 Spare : 1;
)");
  EXPECT_EQ(dbc.messages.size(), 4u);
}

TEST(Dbc, ReportsContradictoryMultiplexors) {
  const auto contains = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  const auto without = [](const std::string& part) { return replaced(kExtended, part, ""); };
  contains(bad(without("SG_MUL_VAL_ 80 Deep Sub 3-5,\n   7-7;\n")),
           "a.dbc:5: signal Deep: Multi has two multiplexors, Page and Sub, and no SG_MUL_VAL_");
  contains(bad(replaced(kExtended, "Deep m3", "Deep m9")),
           "a.dbc:10: SG_MUL_VAL_ contradicts signal Deep (line 5)");
  contains(bad(replaced(kExtended, "Deep m3", "Deep")), "SG_MUL_VAL_ contradicts signal Deep");
  contains(bad(replaced(kExtended, "Deep Sub", "Deep Subs")), "Multi has no multiplexor Subs");
  contains(bad(replaced(kExtended, "Deep Sub", "Deep Always")), "Multi has no multiplexor Always");
  contains(bad(replaced(kExtended, "80 Deep", "80 Deeper")), "message 80 has no signal Deeper");
  contains(bad(replaced(kExtended, "3-5,", "3-6,")), "signal Other overlaps Deep (line 5)");
  contains(bad(replaced(kExtended, "0-1;", "0-2;")), "signal Flat overlaps Deep (line 5)");
  contains(
      bad(replaced(kExtended, "Sub Page 2-2", "Sub Deep 2-2") + "SG_MUL_VAL_ 80 Page Sub 1-1;"),
      "SG_MUL_VAL_");
  contains(bad(replaced(kExtended, "7-7;", "300-300;")), "multiplexor Sub has 8 bits");
  for (const char* ranges : {"5-3;", "3;", "3-;", "x-5;", "3-5 7-7;", "3-5", ";"})
    contains(bad(replaced(kExtended, "0-1;", ranges)),
             "a.dbc:12: SG_MUL_VAL_ is followed by id, signal, multiplexor, ranges");
  std::string circle = "BO_ 80 Multi: 8 A\n";
  for (int i = 0; i < 3; ++i)
    circle += fmt::format(" SG_ S{} m1M : {}|8@1+ (1,0) [0|0] \"\" A\n", i, 8 * i);
  for (int i = 0; i < 3; ++i)
    circle += fmt::format("SG_MUL_VAL_ 80 S{} S{} 1-1;\n", i, (i + 1) % 3);
  contains(bad(circle), "a.dbc:2: signal S0: more than 16 multiplexors switch one another, or");
}

TEST(Dbc, ReportsEveryBrokenRuleWithItsLine) {
  const auto contains = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  contains(bad(replaced(kGood, "16|16@1- (0.001", "8|16@1- (0.001")),
           "a.dbc:14: signal AccY overlaps AccX (line 13)");
  contains(bad(replaced(kGood, "48|16@1+", "56|16@1+")), "a.dbc:16: signal Count: 16 bits");
  contains(bad(replaced(kGood, "Kind M :", "Kind :")), "A is multiplexed and Multi has no");
  contains(bad(replaced(kGood, " F :", " F M :")), "Multi has two multiplexors, Kind and F");
  contains(bad(replaced(kGood, "B m2", "B m300")), "has 8 bits and is never 300");
  contains(bad(replaced(kGood, "B m2", "B m1")), "signal B overlaps A");
  contains(bad(replaced(kGood, "B m2", "B mx")), "expected M, m<number> or a colon");
  contains(bad(replaced(kGood, "(0.001,0)", "(0,0)")), "factor must be finite and not 0");
  contains(bad(replaced(kGood, "(0.001,0)", "(nan,0)")), "a.dbc:13");
  contains(bad(replaced(kGood, "@1-", "@2-")), "a.dbc:13: signal AccX: expected start|bits");
  contains(bad(replaced(kGood, "32|32@1-", "32|16@1-")), "is floating and has 16 bits, not 32");
  contains(bad(replaced(kGood, "BO_ 52", "BO_ 1409")), "Xsens has the id of Raw (line 12)");
  contains(bad(replaced(kGood, " Xsens:", " Raw:")), "a.dbc:12: Raw has the name of Raw (line 18)");
  contains(bad(replaced(kGood, "BO_ 52", "BO_ 1409")),
           "a.dbc:12: Raw has the id of Xsens (line 18)");
  contains(bad(replaced(kGood, "BO_ 52", "BO_ 2048")), "2048 of Xsens is not a valid 11-bit id");
  contains(bad(replaced(kGood, "Raw: 8", "Raw: 9")), "no CAN frame has 9 bytes");
  contains(bad(replaced(kGood, "Raw: 8", "Raw: 1785")), "no CAN frame has more than 64 bytes");
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
    for (const DbcMessage& m : dbc->messages) {
      if (!broken_rules(m).empty()) continue;
      for (const DbcSignal& s : m.signals) ASSERT_TRUE(fits(s.field, m.length));
    }
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
  const std::vector<DbcRule> rules = broken_rules(*dbc->find("Many"));
  ASSERT_EQ(rules.size(), 1u);
  EXPECT_NE(rules[0].message.find("Many has too many signals"), std::string::npos);
}

}  // namespace dbc_test
}  // namespace framewatch::drivers
