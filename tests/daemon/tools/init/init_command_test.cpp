// SPDX-License-Identifier: MIT
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace init_command_test {

using test::ShellResult;

class InitCommand : public testing::Test {
 protected:
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }

  test::TemporaryDirectory directory_;
};

constexpr const char* kHouse =
    "--live lcm --stories 2 --bays 1x1 --span-x 6 --span-y 4 --heights 3 --mass 300kg/m2";

TEST_F(InitCommand, ReportsAllMissingAnswersWithoutATerminal) {
  const ShellResult said = shell("$F init --stories 2");
  EXPECT_EQ(said.status, kBadInput);
  for (const char* option : {"--live", "--bays", "--span-x", "--span-y", "--heights", "--mass"})
    EXPECT_NE(said.err.find(std::string(option) + ": is missing: "), std::string::npos)
        << option << "\n"
        << said.err;
  EXPECT_NE(said.err.find("framewatch init: 6 answers missing or wrong"), std::string::npos);
  EXPECT_EQ(shell("ls").out, "");
}

TEST_F(InitCommand, WritesWhatCheckAccepts) {
  const ShellResult said = shell(std::string("$F init ") + kHouse);
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("building.toml: written. Next steps:\n  framewatch check building.toml\n"
                          "  framewatch run building.toml\n"),
            std::string::npos)
      << said.out;
  EXPECT_NE(said.out.find("frames y1 to y2 move along x, frames x1 to x2 move along y"),
            std::string::npos)
      << said.out;
  EXPECT_EQ(shell("$F check building.toml").status, 0);
}

/// Runs on a terminal of `script`.
TEST_F(InitCommand, AsksOnATerminal) {
  const ShellResult said = shell(
      "printf 'none\\nlcm\\n\\n2\\nx\\n\\n3.5\\n\\n18 t\\n\\n\\n\\n' | "
      "timeout 60 script -qec \"$F init\" /dev/null");
  EXPECT_EQ(said.status, 0) << said.out;
  EXPECT_NE(said.out.find("How many stories does it have"), std::string::npos) << said.out;
  EXPECT_NE(said.out.find("frame y1 moves along x"), std::string::npos) << said.out;
  EXPECT_EQ(shell("$F check building.toml").status, 0);
  const ShellResult left =
      shell("printf 'none\\nquit\\n' | timeout 60 script -qec \"$F init --out b.toml\" /dev/null");
  EXPECT_EQ(left.status, kBadInput) << left.out;
  EXPECT_FALSE(left.out.find("stopped; nothing was written") == std::string::npos) << left.out;
  EXPECT_EQ(shell("ls b.toml*").out, "");
}

TEST_F(InitCommand, OverwritesAFileOnlyIfForced) {
  test::write_file(directory_.path("building.toml"), "mine\n");
  const ShellResult said = shell(std::string("$F init ") + kHouse);
  EXPECT_EQ(said.status, kBadInput);
  EXPECT_NE(said.err.find("building.toml: already exists; use --force"), std::string::npos);
  EXPECT_EQ(test::read_file(directory_.path("building.toml")), "mine\n");
  EXPECT_EQ(shell(std::string("$F init --force ") + kHouse).status, 0);
  EXPECT_EQ(shell("$F check building.toml").status, 0);
}

TEST_F(InitCommand, WritesOnlyTheConfigurationToStandardOutput) {
  const ShellResult said = shell(std::string("$F init --out - ") + kHouse + " | $F check -");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(shell(std::string("$F init --out - --quiet ") + kHouse).err, "");
}

TEST_F(InitCommand, ReportsImplausibleValuesAtOnce) {
  const ShellResult said = shell(
      "$F init --live lcm --stories 2 --bays 1x1 --span-x 6 --span-y 4 "
      "--heights 400 --mass 7");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("structure.story_height_m: 400 m"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("mass in tonnes where kg is asked?"), std::string::npos) << said.err;
}

TEST_F(InitCommand, ColumnsAreNeverGuessed) {
  test::write_file(directory_.path("r.csv"), "time_s,base,acc1,acc2\n0,0,0,0\n0.01,0,0,0\n");
  const std::string plane =
      "$F init --record r.csv --directions x --stories 2 --heights 3 --mass 900 ";
  const ShellResult said = shell(plane);
  EXPECT_EQ(said.status, kBadInput);
  EXPECT_NE(
      said.err.find("--channel NAME=1:y1: is missing: Which column belongs to floor 1, frame y1, "
                    "along x? Columns without a place: acc1, acc2."),
      std::string::npos)
      << said.err;
  EXPECT_EQ(shell(plane + "--channel acc1=1:y1 --channel acc2=2:x").status, 0);
  EXPECT_EQ(shell("$F check building.toml").status, 0);
  const ShellResult wrong = shell(plane +
                                  "--force --channel acc1 --channel acc3=1:x "
                                  "--channel acc1=3:x --channel base=1:x --channel acc2=1:x");
  EXPECT_EQ(wrong.status, kBadInput);
  for (const char* part :
       {"acc1: write NAME=PLACE",
        "acc3=1:x: the file has no such column; columns without a place: ",
        "acc1=3:x: this building has no such place; its places are 0:x (base, along x) to 2:y1",
        "acc2=1:x: base already has this place"})
    EXPECT_NE(wrong.err.find(part), std::string::npos) << part << "\n" << wrong.err;
  const ShellResult few = shell(plane + "--force --bays 0x1 --span-y 4");
  EXPECT_NE(few.err.find("this building needs 5 channels"), std::string::npos) << few.err;
}

TEST_F(InitCommand, ReadsSignalsOfACanBus) {
  test::write_file(directory_.path("bus.dbc"),
                   "VERSION \"\"\nBU_: N\n"
                   "BO_ 1 Base: 2 N\n SG_ X : 0|16@1- (0.001,0) [0|0] \"g\" N\n"
                   "BO_ 2 Floor1: 4 N\n SG_ X : 0|16@1- (0.001,0) [0|0] \"g\" N\n"
                   " SG_ Temperature : 16|16@1- (1,0) [0|0] \"C\" N\n");
  const ShellResult said =
      shell("$F init --live can --dbc bus.dbc --directions x --stories 1 --heights 3 --mass 900");
  ASSERT_EQ(said.status, 0) << said.err;
  const std::string text = test::read_file(directory_.path("building.toml"));
  EXPECT_NE(text.find("name = \"Floor1.X\"\nstory = 1\nframe = \"y1\"  # along x\nsource = { can = "
                      "\"can0\", dbc_signal = \"Floor1.X\" }\nscale = 9.80665"),
            std::string::npos)
      << text;
  EXPECT_EQ(shell("$F check building.toml").status, 0) << shell("$F check building.toml").err;
}

TEST_F(InitCommand, DrawsFloorsAndPlan) {
  const ShellResult said = shell(
      "$F init --live none --stories 12 --sensors 0,4,8,12 --per-level xxy --span-x 30 --span-y 18 "
      "--heights 3.6 --mass 600kg/m2 --drawing plan.svg");
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* line :
       {"   12 roof  F12-Y1 F12-Y2 F12-y\n   11 to 9  none\n", "  base  base-x1 base-x2 base-y\n",
        "Plan of floors 12 roof, 8, 4, base (> along x"})
    EXPECT_NE(said.out.find(line), std::string::npos) << line << "\n" << said.out;
  const std::string svg = test::read_file(directory_.path("plan.svg"));
  EXPECT_EQ(svg.find("<svg "), 0u);
  for (const char* name : {">F12-Y1<", ">F12-y<", ">Plan of floors 12 roof, 8, 4, base<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name << "\n" << svg;
  EXPECT_EQ(shell("$F check building.toml").status, 0);
  const ShellResult again = shell(std::string("$F init --out b.toml --drawing plan.svg ") + kHouse);
  EXPECT_EQ(again.status, kBadInput);
  EXPECT_NE(again.err.find("plan.svg: already exists"), std::string::npos) << again.err;
  const ShellResult picture =
      shell(std::string("$F init --out b.toml --drawing plan.png ") + kHouse);
  EXPECT_NE(picture.err.find("--drawing plan.png: the drawing is SVG"), std::string::npos)
      << picture.err;
  EXPECT_EQ(shell("ls b.toml plan.png").status, 2) << "bad input writes nothing";
}

TEST_F(InitCommand, RefusesImpossibleLayouts) {
  const std::string tower =
      "$F init --live none --stories 4 --span-x 6 --span-y 4 --heights 3 --mass 9t ";
  for (const auto& [options, reason] :
       {std::pair("--sensors 0,5", "5: floors from 0 (base) to 4 (roof)"),
        std::pair("--sensors 2,roof,4", "the same floor twice"),
        std::pair("--sensors base", "one floor above the base at least"),
        std::pair("--per-level z", "a letter for each channel on a floor"),
        std::pair("--bays 1x1 --per-level xxxyy", "3 channels along x, but 2 frames move along it"),
        std::pair("--directions both --per-level xx", "no channel along y"),
        std::pair("--bays 1x1 --channel 'A=5@(0,0):x'", "write NAME=FLOOR@(X,Y):x"),
        std::pair("--bays 1x1 --channel 'A=1@(0):x'", "write NAME=FLOOR@(X,Y):x"),
        std::pair("--bays 1x1 --channel '=1@(0,0):x'", "the channel needs a name")}) {
    const ShellResult said = shell(tower + options);
    EXPECT_EQ(said.status, kBadInput) << options;
    EXPECT_NE(said.err.find(reason), std::string::npos) << options << "\n" << said.err;
  }
  EXPECT_EQ(shell("ls").out, "");
}

}  // namespace init_command_test
}  // namespace framewatch::daemon
