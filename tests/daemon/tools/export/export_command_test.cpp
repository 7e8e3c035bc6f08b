// SPDX-License-Identifier: MIT
#include "daemon/tools/export/export_command.h"

#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace export_command_test {

using test::ShellResult;

constexpr const char* kBuilding = R"([structure]
name = "table"
stories = 2
frames_x = ["y1", "y2"]
frames_y = ["x1", "x2"]
span_x_m = 6
span_y_m = 4
story_height_m = 3
node_mass_kg = 1000

[structure.design]
kx_npm = [[9e5, 7e5], [8e5, 6e5]]
ky_npm = [[5e5, 4e5], [4e5, 3e5]]
gk = 3e5
damping_ratio = 0.02

[[channel]]
name = "base-x"
story = 0
direction = "x"

[[channel]]
name = "base-y"
story = 0
direction = "y"

[[channel]]
name = "F2-Y1"
story = 2
frame = "y1"

[[channel]]
name = "F2-X1"
story = 2
frame = "x1"
)";

class ExportCommand : public testing::Test {
 protected:
  ExportCommand() { test::write_file(directory_.path("b.toml"), kBuilding); }
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }
  void add(const std::string& text) {
    test::write_file(directory_.path("b.toml"), kBuilding + text);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(ExportCommand, WritesScriptsAndMatrices) {
  const ShellResult said = shell("$F export b.toml --opensees o --matrices m");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.err, "");
  EXPECT_NE(said.out.find("o/model.tcl, o/model.py: written\nm: M, C and K of 8 rows written"),
            std::string::npos)
      << said.out;
  EXPECT_EQ(shell("ls o m").out,
            "m:\nC.mtx\nK.mtx\nM.mtx\nframes.mtx\nmatrices.mat\nr.mtx\nrows.csv\n\no:\nmodel.py\n"
            "model.tcl\n");
  EXPECT_EQ(shell("sed -n 2p m/rows.csv; tail -1 m/rows.csv").out,
            "1,\"floor 1, frame y1\",1,x,m\n8,\"floor 2, frame x2\",2,y,m\n");
  EXPECT_NE(shell("cat o/model.tcl").out.find("natural frequencies: "), std::string::npos);
}

/// Runs the script of Python with a stand-in for openseespy that prints each call.
TEST_F(ExportCommand, PythonRunsItsScript) {
  if (shell("python3 -c ''").status != 0) GTEST_SKIP() << "python3 is not installed";
  ASSERT_EQ(shell("$F export b.toml --opensees o --quiet && mkdir openseespy").status, 0);
  test::write_file(directory_.path("openseespy/opensees.py"),
                   "def __getattr__(name):\n  return lambda *words: print(name, *words)\n");
  const ShellResult python = shell("PYTHONPATH=. python3 o/model.py");
  ASSERT_EQ(python.status, 0) << python.err;
  EXPECT_NE(python.out.find("\nrigid"), 0u);
  EXPECT_EQ(shell("PYTHONPATH=. python3 o/model.py | grep -c ^element").out, "10\n");
  EXPECT_NE(python.out.find("\nfix 1 1 1 1 1 1 1\n"), std::string::npos) << python.out;
}

TEST_F(ExportCommand, RefusesAndWritesNothing) {
  EXPECT_NE(shell("$F export b.toml").err.find("give --opensees DIR, --matrices DIR or both"),
            std::string::npos);
  shell("mkdir -p full && touch full/mine");
  const ShellResult full = shell("$F export b.toml --opensees full --matrices m");
  EXPECT_EQ(full.status, kBadInput);
  EXPECT_NE(full.err.find("full: is not empty; use --force"), std::string::npos) << full.err;
  EXPECT_EQ(shell("$F export b.toml --opensees b.toml").status, kBadInput);
  add("\n[[effect]]\nkind = \"stiffness_drop\"\nstory = 1\nframe = \"y1\"\ndk_npm = -1e5\nat_s = "
      "9\n");
  for (const char* option : {"--opensees", "--matrices"}) {
    const ShellResult lost = shell(fmt::format("$F export b.toml {} lost", option));
    EXPECT_EQ(lost.status, kBadInput);
    EXPECT_NE(lost.err.find("stiffness_drop at story 1, frame y1: "), std::string::npos)
        << lost.err;
  }
  EXPECT_EQ(shell("ls").out, "b.toml\nfull\n") << "bad input writes nothing";
  const ShellResult without =
      shell("$F export b.toml --opensees full --force --without stiffness_drop");
  EXPECT_EQ(without.status, 0) << without.err;
  EXPECT_NE(without.err.find("left out: stiffness_drop at story 1, frame y1"), std::string::npos);
  EXPECT_NE(
      shell("$F export b.toml --opensees o --without fog").err.find("--without fog: no effect"),
      std::string::npos);
  shell("sed -i '/structure.design/,/damping_ratio/d' b.toml");
  EXPECT_NE(shell("$F export b.toml --opensees o").err.find("has no [structure.design] to export"),
            std::string::npos);
}

TEST_F(ExportCommand, SaysThatASymmetricPlanHidesItsPanels) {
  shell("sed -i 's/^kx_npm.*/kx_npm = 8e5/; s/^ky_npm.*/ky_npm = 5e5/' b.toml");
  const ShellResult said = shell("$F export b.toml --opensees o");
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.err.find("the plan is symmetric: no record shows the floor panels"),
            std::string::npos)
      << said.err;
}

/// The design goes out as matrices and comes back into `diagnose`.
TEST_F(ExportCommand, DiagnoseRefusesMatricesOfAnotherBuilding) {
  ASSERT_EQ(shell("$F export b.toml --matrices m --quiet").status, 0);
  test::write_file(directory_.path("r.csv"), "time_s,base-x,base-y,F2-Y1,F2-X1\n0,0,0,0,0\n");
  const std::string diagnose = "$F diagnose b.toml --train r.csv --holdout r.csv --out d --design ";
  EXPECT_EQ(shell(diagnose + "m").err.find("m/"), std::string::npos) << "the matrices are right";
  for (const auto& [change, reason] :
       {std::pair("rm n/C.mtx", "n/C.mtx: "),
        std::pair("sed -i '4s/ 2000/ 2100/' n/M.mtx",
                  "n/M.mtx: row 1 (floor 1, frame y1), column 1"),
        std::pair("sed -i '3s/8 8/9 9/' n/K.mtx", "n/K.mtx:3: the building's matrices have 8 rows"),
        std::pair("sed -i '5s/.*/9 9 1/' n/K.mtx", "n/K.mtx:5: an entry is row, column"),
        std::pair("sed -i '5s/.*/1 2 nan/' n/K.mtx", "n/K.mtx:5: an entry is row, column"),
        std::pair("sed -i '$d' n/K.mtx", "the file ends after "),
        std::pair("echo 1 1 1 >>n/K.mtx", "the file goes on after its last entry"),
        std::pair("sed -i 1d n/K.mtx", "n/K.mtx:1: write %%MatrixMarket matrix"),
        std::pair("sed -i '5s/ [-0-9.]*$/ 9e7/' n/K.mtx",
                  "n/K.mtx: the frames and floor panels of the building leave ")}) {
    shell(std::string("rm -rf n; cp -r m n; ") + change);
    const ShellResult said = shell(diagnose + "n");
    EXPECT_EQ(said.status, kBadInput) << change;
    EXPECT_NE(said.err.find(reason), std::string::npos) << change << "\n" << said.err;
  }
  EXPECT_EQ(shell("ls -d d").status, 2) << "bad input writes nothing";
}

}  // namespace export_command_test
}  // namespace framewatch::daemon
