// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace usage_test {

using test::ShellResult;

class Usage : public testing::Test {
 protected:
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }

  /// Returns the first words of the list that --help prints below a heading.
  std::vector<std::string> listed(const std::string& command, const std::string& heading) {
    std::istringstream lines(shell("$F help " + command).out);
    std::vector<std::string> out;
    std::string line;
    for (bool inside = false; std::getline(lines, line);) {
      if (line.ends_with(':') && line.find(' ') == std::string::npos) inside = line == heading;
      if (!inside || !line.starts_with("  ") || line[2] == ' ') continue;
      std::string word = line.substr(2, line.find_first_of(" ,={", 2) - 2);
      if (word == "-h") word = "--help";
      out.push_back(word);
    }
    return out;
  }
  /// Leaves out the commands of framewatch-fleet.
  std::vector<std::string> commands() {
    std::vector<std::string> out = listed("", "Subcommands:");
    std::erase_if(out, [](const std::string& c) { return c == "fleet" || c == "uplink"; });
    return out;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Usage, SuggestsTheMeantCommand) {
  const ShellResult said = shell("$F chek building.toml");
  EXPECT_EQ(said.status, kBadInput);
  EXPECT_EQ(said.err, "framewatch: there is no command chek: did you mean check?\n");
  EXPECT_EQ(shell("$F re").err,
            "framewatch: there is no command re: did you mean replay, repair, refine, reproduce, "
            "report or record?\n");
  EXPECT_EQ(shell("$F xyzzy").err,
            "framewatch: there is no command xyzzy: framewatch help lists them\n");
  EXPECT_EQ(shell("$F").err, "framewatch: no command given; run `framewatch help` for a list\n");
  EXPECT_EQ(shell("$F").status, kBadInput);
}

TEST_F(Usage, ReportsEveryMisspeltOptionFirst) {
  const ShellResult said = shell("$F replay --ot x.csv --jsn b.toml a.csv");
  EXPECT_EQ(said.status, kBadInput);
  EXPECT_EQ(said.err,
            "framewatch: there is no option --ot: did you mean --out?\n"
            "framewatch: there is no option --jsn: did you mean --json?\n");
  EXPECT_EQ(shell("$F run --stat=x b.toml").err,
            "framewatch: there is no option --stat: did you mean --state or --state-every?\n");
  EXPECT_EQ(shell("$F check -json b.toml").err,
            "framewatch: there is no option -json: did you mean --json?\n");
  EXPECT_EQ(shell("$F check --zzz b.toml").err,
            "framewatch: there is no option --zzz: framewatch help check lists them\n");
  // A word after -- is a name, whatever it looks like.
  EXPECT_NE(shell("$F check -- --jsn").err.find("No such file"), std::string::npos);
}

TEST_F(Usage, NamesCommandAndHelpAfterBadUsage) {
  EXPECT_EQ(shell("$F check").err,
            "framewatch check: CONFIG is required\nrun `framewatch help check` for its usage\n");
  EXPECT_EQ(shell("$F demo --seconds no").status, kBadInput);
}

TEST_F(Usage, PrintsTheHelpOfACommand) {
  for (const std::string& command : commands()) {
    const ShellResult help = shell("$F help " + command);
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_EQ(help.out, shell("$F " + command + " --help").out) << command;
  }
  EXPECT_EQ(shell("$F help").out, shell("$F --help").out);
  EXPECT_EQ(shell("$F help chek").err,
            "framewatch help: there is no command chek: did you mean check?\n");
  EXPECT_EQ(shell("$F help chek").status, kBadInput);
}

TEST_F(Usage, RunsFleetAsASeparateProgram) {
  const auto all = listed("", "Subcommands:");
  EXPECT_EQ(std::count(all.begin(), all.end(), "fleet"), 1);
  const ShellResult alone = shell(
      "cp $F framewatch; for c in fleet uplink; do PATH=/usr/bin:/bin ./framewatch $c x; done");
  EXPECT_EQ(alone.status, kBadInput);
  EXPECT_EQ(alone.err,
            "framewatch fleet: needs the program framewatch-fleet; install the Debian package "
            "framewatch-fleet\nframewatch uplink: needs the program framewatch-fleet; install the "
            "Debian package framewatch-fleet\n");
  // A program of that name beside the program, or in PATH, gets the remaining words.
  test::write_file(directory_.path("framewatch-fleet"), "#!/bin/sh\necho \"$@\"\n");
  EXPECT_EQ(shell("chmod +x framewatch-fleet; ./framewatch fleet task m 1").out, "task m 1\n");
  EXPECT_EQ(shell("./framewatch uplink b.toml").out, "uplink b.toml\n");
}

TEST_F(Usage, FailsIfStandardOutputFails) {
  const std::string table = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  std::vector<std::string> lines{"$F --help",         "$F --version",
                                 "$F help --man",     "$F completion bash",
                                 "$F check " + table, "$F check " + table + " --json",
                                 "$F selftest"};
  for (const std::string& command : commands()) lines.push_back("$F " + command + " --help");
  for (const std::string& line : lines) {
    const ShellResult said = shell(line + " >/dev/full");
    EXPECT_EQ(said.status, kBadInput) << line;
    EXPECT_NE(said.err.find("standard output: "), std::string::npos) << line << "\n" << said.err;
  }
}

TEST_F(Usage, BashCompletesCommandsOptionsAndWords) {
  const auto completed = [&](const std::string& words) {
    const ShellResult said =
        shell("eval \"$($F completion bash)\"; compopt() { :; }; COMP_WORDS=(" + words +
              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _framewatch; echo \"${COMPREPLY[*]}\"");
    EXPECT_EQ(said.err, "") << words;
    return said.out;
  };
  EXPECT_EQ(completed("framewatch rep"), "replay repair reproduce report\n");
  EXPECT_EQ(completed("framewatch replay --j"), "--junit --json\n");
  EXPECT_EQ(completed("framewatch record b.toml --send st"), "start stop\n");
  EXPECT_EQ(completed("framewatch help sel"), "selftest\n");
  EXPECT_EQ(completed("framewatch completion z"), "zsh\n");
  test::write_file(directory_.path("b one.toml"), "");
  EXPECT_EQ(completed("framewatch check b"), "b one.toml\n");
}

TEST_F(Usage, CompletionAndManualListEveryCommandAndOption) {
  const std::string bash = shell("$F completion bash").out, zsh = shell("$F completion zsh").out,
                    fish = shell("$F completion fish").out, manual = shell("$F help --man").out;
  ASSERT_GE(commands().size(), 22u);
  for (const std::string& command : commands()) {
    EXPECT_NE(manual.find("\n.BR framewatch\\-" + command + " (1)\n"), std::string::npos);
    EXPECT_NE(zsh.find("\n    " + command + ")\n"), std::string::npos) << command;
    EXPECT_NE(fish.find(" -a " + command + " -d "), std::string::npos) << command;
    const std::size_t at = bash.find("\n    " + command + ") options='");
    ASSERT_NE(at, std::string::npos) << command;
    const std::string options = bash.substr(at, bash.find('\n', at + 1) - at);
    const std::string page = shell("$F help " + command + " --man").out;
    for (const std::string& option : listed(command, "Options:")) {
      EXPECT_NE(options.find(option), std::string::npos) << command << " " << option;
      EXPECT_NE(zsh.find(option + "["), std::string::npos) << command << " " << option;
      EXPECT_NE(fish.find("'__framewatch_command_is " + command + "' -"), std::string::npos)
          << command;
      EXPECT_NE(fish.find(" -l " + option.substr(2) + " "), std::string::npos) << option;
      if (option == "--help") continue;
      std::string escaped;
      for (const char c : option) escaped += c == '-' ? "\\-" : std::string(1, c);
      const std::size_t item = page.find("\n.BI \"" + escaped);
      ASSERT_NE(item, std::string::npos) << command << option;
      EXPECT_NE(std::string("\" ").find(page[item + 6 + escaped.size()]), std::string::npos)
          << page;
    }
  }
}

/// Uses the shells of this machine; otherwise only the test above applies.
TEST_F(Usage, ShellsAcceptTheirScripts) {
  for (const std::string check : {"bash -n", "zsh -n", "fish --no-execute"}) {
    const std::string name = check.substr(0, check.find(' '));
    const ShellResult said = shell("type -p " + name + " >/dev/null || exit 0; $F completion " +
                                   name + " >script && " + check + " script");
    EXPECT_EQ(said.status, 0) << check << "\n" << said.err;
    EXPECT_EQ(said.err, "") << check;
  }
}

TEST_F(Usage, ManualPagesPassGroff) {
  for (const std::string& command : commands()) {
    const ShellResult said = shell("type -p groff >/dev/null || exit 0; $F help " + command +
                                   " --man | groff -man -Tutf8 -ww -z");
    EXPECT_EQ(said.status, 0) << command;
    EXPECT_EQ(said.err, "") << command;
  }
}

TEST_F(Usage, InstallsPagesAndScripts) {
  const ShellResult said =
      shell(FRAMEWATCH_SOURCE_DIR "/deploy/install-shell-files $F share && ls share/man/man1");
  EXPECT_EQ(said.status, 0) << said.err;
  for (const std::string& command : commands())
    EXPECT_NE(said.out.find("framewatch-" + command + ".1\n"), std::string::npos) << command;
  for (const char* script :
       {"bash-completion/completions/framewatch", "zsh/vendor-completions/_framewatch",
        "fish/vendor_completions.d/framewatch.fish"})
    EXPECT_FALSE(test::read_file(directory_.path("share/" + std::string(script))).empty());
}

}  // namespace usage_test
}  // namespace framewatch::daemon
