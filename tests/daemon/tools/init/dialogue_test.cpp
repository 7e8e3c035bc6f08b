// SPDX-License-Identifier: MIT
#include "daemon/tools/init/dialogue.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/init/building_toml.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace dialogue_test {

/// A person who types these lines, and the program's output.
class Person {
 public:
  std::optional<BuildingPlan> answer(const std::vector<std::string>& lines,
                                     InitAnswers answers = {}) {
    said.clear();
    std::size_t at = 0;
    const Terminal terminal{
        [&]() { return at < lines.size() ? std::optional(lines[at++]) : std::nullopt; },
        [&](const std::string& text) { said += text; }};
    const Remarks none = [](const BuildingPlan&) { return std::string(); };
    auto plan = ask_building(std::move(answers), "building.toml", none, files_, terminal);
    unread = lines.size() - at;
    return plan;
  }
  std::string said;
  std::size_t unread = 0;

 private:
  ColumnCache files_;
};

TEST(InitDialogue, DefaultsAndAnswersMakeABuilding) {
  Person person;
  const auto plan = person.answer({"", "lcm", "", "3", "x", "", "3.5", "", "18 t", "", "", ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_EQ(person.unread, 0u);
  const Config config = test::good(building_toml(*plan));
  EXPECT_EQ(config.pipeline.structure.stories, 3);
  EXPECT_EQ(config.pipeline.structure.node_mass, std::vector<double>(3, 18000.0));
  EXPECT_NE(person.said.find("= 3.5 m, 10.5 m in all"), std::string::npos) << person.said;
  EXPECT_NE(person.said.find("Enter writes building.toml"), std::string::npos);
}

TEST(InitDialogue, AsksAgainAfterAWrongAnswerAndLetsEveryAnswerChange) {
  Person person;
  const auto plan =
      person.answer({"none", "lcm", "", "three", "3", "x", "", "3.5,3", "4,3,3", "", "18 t", "", "",
                     "4",  // stories: the heights no longer fit
                     "2", "4,3.5", ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_EQ(plan->structure.story_height, (std::vector<double>{4, 3.5}));
  EXPECT_NE(person.said.find("Please answer again: a whole number from 1 to 200"),
            std::string::npos)
      << person.said;
  EXPECT_NE(person.said.find("Please answer again: there are 3 numbers"), std::string::npos)
      << person.said;
}

TEST(InitDialogue, BackReturnsToThePreviousQuestion) {
  Person person;
  const auto plan = person.answer({"back", "", "can", "back", "lcm", "", "3", "back", "2", "x", "",
                                   "3", "", "900", "none", "200", ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_EQ(plan->structure.stories, 2);
  EXPECT_EQ(plan->rate_hz, 200);
  EXPECT_NE(person.said.find("This is the first question."), std::string::npos);
}

TEST(InitDialogue, QuitOrTheEndOfInputWritesNothing) {
  Person person;
  EXPECT_FALSE(person.answer({"", "lcm", "quit"}));
  EXPECT_FALSE(person.answer({"", "lcm"}));
  EXPECT_FALSE(person.answer({"", "lcm", "", "3", "x", "", "3.5", "", "18 t", "", "", "quit"}));
}

TEST(InitDialogue, AsksOnlyWhatOptionsDoNotAnswer) {
  Person person;
  InitAnswers answers;
  answers.by_option = {{"record", "none"}, {"live", "none"}, {"building", "b"},
                       {"stories", "1"},   {"bays", "0x0"},  {"directions", "x"},
                       {"sensors", "all"}, {"heights", "3"}, {"start", "none"},
                       {"rate", "100"}};
  ASSERT_TRUE(person.answer({"500", ""}, answers)) << person.said;
  EXPECT_EQ(person.said.find("stories does it have"), std::string::npos) << person.said;
}

TEST(InitDialogue, AsksForColumnsWithoutAPlace) {
  const test::TemporaryDirectory directory;
  const std::string record = directory.path("r.csv");
  test::write_file(record, "time_s,base,acc2,acc1,spare\n0,0,0,0,0\n0.005,0,0,0,0\n");
  Person person;
  const auto plan =
      person.answer({record, "", "", "2", "x", "", "3", "", "900", "none", "acc7", "acc1",
                     "acc2",  // floor 1: first a missing column, then an existing one
                     ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_EQ(plan->channels[0].column.name, "base");
  EXPECT_EQ(plan->channels[1].column.name, "acc1");
  EXPECT_EQ(plan->channels[2].column.name, "acc2");
  EXPECT_EQ(plan->rate_hz, 200);
  EXPECT_NE(person.said.find("Which column belongs to floor 1, frame y1, along x? Columns without "
                             "a place: acc2, acc1, "
                             "spare."),
            std::string::npos)
      << person.said;
  EXPECT_NE(person.said.find("left out         spare"), std::string::npos) << person.said;
  // At the end the two are exchanged.
  const auto changed = person.answer({record, "", "", "2", "x", "", "3", "", "900", "none", "acc1",
                                      "acc2", "11", "acc2=1:y1", "acc1", ""});
  ASSERT_TRUE(changed) << person.said;
  EXPECT_EQ(changed->channels[1].column.name, "acc2");
  EXPECT_EQ(changed->channels[2].column.name, "acc1");
}

TEST(InitDialogue, AWrongChannelKeepsTheOthers) {
  const test::TemporaryDirectory directory;
  const std::string record = directory.path("r.csv");
  test::write_file(record, "time_s,a,b\n0,0,0\n0.005,0,0\n");
  InitAnswers answers;
  answers.by_option = {{"record", record},  {"live", "none"},  {"building", "b"}, {"stories", "1"},
                       {"directions", "x"}, {"bays", "0x0"},   {"heights", "3"},  {"mass", "900"},
                       {"start", "none"},   {"sensors", "all"}};
  answers.channels = {"bad=9:z", "b=1:y1"};
  Person person;
  const auto plan = person.answer({"a", ""}, answers);
  ASSERT_TRUE(plan) << person.said;
  EXPECT_EQ(plan->channels[0].column.name, "a");
  EXPECT_EQ(plan->channels[1].column.name, "b");
}

TEST(InitDialogue, AsksAboutAnAmbiguousComma) {
  Person person;
  InitAnswers answers;
  answers.by_option = {{"record", "none"},  {"live", "lcm"},   {"building", "b"}, {"stories", "2"},
                       {"directions", "x"}, {"bays", "0x0"},   {"mass", "900"},   {"start", "none"},
                       {"rate", "100"},     {"sensors", "all"}};
  const auto plan = person.answer({"3,5", "3, 5", ""}, answers);
  ASSERT_TRUE(plan) << person.said;
  EXPECT_NE(person.said.find("the comma may be decimal or separate two numbers"), std::string::npos)
      << person.said;
  EXPECT_EQ(plan->structure.story_height, (std::vector<double>{3, 5}));
}

TEST(InitDialogue, AsksForTheUnitOfARecord) {
  const test::TemporaryDirectory directory;
  const std::string record = directory.path("r.csv");
  test::write_file(record, "Time;base_x;roof_x\n0;0;0\n0.01;0;0\n");
  Person person;
  const auto plan = person.answer(
      {record, record + " --unit g", "", "", "1", "x", "", "3", "", "900", "none", ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_NE(person.said.find("the header does not say the unit"), std::string::npos) << person.said;
  EXPECT_EQ(plan->record, record + " --unit g");
}

TEST(InitDialogue, AsksAboutAmbiguousTitles) {
  const test::TemporaryDirectory directory;
  const std::string record = directory.path("r.csv");
  test::write_file(record,
                   "time_s,base_x,base_y,A1Y1,A1Y2,A1X1,A1X2\n0,0,0,0,0,0,0\n0.01,0,0,0,0,0,0\n");
  Person person;
  const auto plan = person.answer({record, "", "", "1", "", "1x1", "6", "4", "3", "", "", "",
                                   "9000", "none", "directions", ""});
  ASSERT_TRUE(plan) << person.said;
  EXPECT_NE(
      person.said.find("A1Y1 can be read in two ways:\n  frames      floor 1, frame y1, along "
                       "x\n  directions  floor 1, frame x1, along y"),
      std::string::npos)
      << person.said;
  EXPECT_EQ(plan->channels[2].column.name, "A1X1");
}

}  // namespace dialogue_test
}  // namespace framewatch::daemon
