// SPDX-License-Identifier: MIT
// Layouts of accelerometers of buildings and laboratories, tests/init/layouts: init describes each
// from options alone, and check accepts its file without an edit. Those of known buildings are like
// them; levels and sizes are not copied from their sheets.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace layouts_test {

constexpr std::size_t kLayouts = 10;

/// A file of tests/init/layouts: a comment, then lines "key: value".
struct Layout {
  std::string name, options, columns;
  std::size_t channels = 0;  ///< that the estimation uses
  std::set<int> floors;      ///< that they measure
};

Layout read_layout(const std::filesystem::path& path) {
  Layout out;
  out.name = path.stem().string();
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with('#') || colon == std::string::npos) continue;
    const std::string key = line.substr(0, colon), value = line.substr(colon + 2);
    if (key == "options") out.options += value + " ";
    if (key == "columns") out.columns = value;
    if (key == "channels") out.channels = std::stoul(value);
    std::istringstream floors(value);
    for (int floor = 0; key == "floors" && floors >> floor;) out.floors.insert(floor);
  }
  return out;
}

std::vector<Layout> layouts() {
  std::vector<Layout> out;
  const std::filesystem::path folder = FRAMEWATCH_SOURCE_DIR "/tests/init/layouts";
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    out.push_back(read_layout(entry.path()));
  return out;
}

/// A record of three samples with these titles.
std::string record_text(const std::string& columns) {
  std::string zeros;
  for (const char c : columns)
    if (c == ',' || c == ';') zeros += std::string(1, c) + "0";
  return fmt::format("{}\n0{}\n0.01{}\n0.02{}\n", columns, zeros, zeros, zeros);
}

TEST(InitLayouts, AreDescribedByOptionsAlone) {
  const std::vector<Layout> all = layouts();
  EXPECT_EQ(all.size(), kLayouts);
  for (const Layout& layout : all) {
    SCOPED_TRACE(layout.name);
    const test::TemporaryDirectory directory;
    std::string line = "$F init " + layout.options;
    if (!layout.columns.empty()) {
      test::write_file(directory.path("record.csv"), record_text(layout.columns));
      line += "--record record.csv";
    }
    const test::ShellResult said = test::shell(directory, line);
    ASSERT_EQ(said.status, 0) << said.err;
    const test::ShellResult check = test::shell(directory, "$F check building.toml");
    EXPECT_EQ(check.status, 0) << check.err;
    std::vector<ConfigProblem> problems;
    const auto config = load_config(directory.path("building.toml"), problems);
    ASSERT_TRUE(config && problems.empty());
    std::set<int> floors;
    for (const estimator::SensorAxis& axis : config->pipeline.axes) floors.insert(axis.story);
    EXPECT_EQ(config->pipeline.axes.size(), layout.channels);
    EXPECT_EQ(floors, layout.floors);
  }
}

}  // namespace layouts_test
}  // namespace framewatch::daemon
