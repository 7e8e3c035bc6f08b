// SPDX-License-Identifier: MIT
// Tests channels of a building from the headers of its network's files.
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "daemon/tools/init/station_layout.h"
#include "tests/support/data.h"
#include "tests/support/shell.h"
#include "tests/support/station_files.h"

namespace framewatch::daemon {
namespace station_init_test {

using test::ShellResult;

ChannelColumn column(const char* place, double azimuth_deg) {
  ChannelColumn out;
  out.name = place;
  out.header.place = place;
  out.header.azimuth_deg = azimuth_deg;
  out.header.elevation_deg = 0;
  return out;
}

TEST(StationLayout, TakesTheAxesOfMostChannelsAndTurnsPlacesWithThem) {
  const std::vector<ChannelColumn> columns = {
      column("Ground floor W side", 20), column("Ground floor", 110), column("Roof E side", 200),
      column("Roof", 110), column("Free field", 0)};
  const auto reading = read_station(columns);
  ASSERT_TRUE(reading);
  EXPECT_DOUBLE_EQ(reading->azimuth_y_deg, 20);
  EXPECT_TRUE(reading->ground_can_be_base && reading->along_x && reading->along_y);
  EXPECT_FALSE(reading->basement_can_be_base);
  EXPECT_TRUE(reading->needs_plan_x);
  EXPECT_FALSE(reading->needs_plan_y);
  StationPlan plan;
  plan.stories = 3;
  plan.x_m = 24;
  std::string why;
  const auto roof = station_place(*reading, columns, 2, plan, why);
  ASSERT_TRUE(roof) << why;
  EXPECT_EQ(roof->story, 3);
  EXPECT_EQ(roof->along, 'y');
  EXPECT_EQ(roof->azimuth_deg, 200);
  EXPECT_EQ(roof->x_m, 24);
  EXPECT_FALSE(roof->y_m);
  EXPECT_EQ(station_place(*reading, columns, 0, plan, why)->x_m, 0);
  EXPECT_EQ(station_place(*reading, columns, 4, plan, why)->why_unused, "not in the building");
}

TEST(StationLayout, ReadsOffsetsAndCoordinatesAsPlacesInMeters) {
  std::vector<ChannelColumn> columns = {column("Ground floor", 0), column("Roof E side", 0)};
  columns[0].header.north_m = -5;
  columns[0].header.east_m = 2;
  columns[1].header.north_m = 5;
  columns[1].header.east_m = 32;
  StationPlan plan;
  std::string why;
  auto at = station_place(*read_station(columns), columns, 1, plan, why);
  EXPECT_NEAR(*at->x_m, 30, 1e-9);
  EXPECT_NEAR(*at->y_m, 10, 1e-9);
  for (ChannelColumn& c : columns) {
    c.header.north_m = c.header.east_m = std::nullopt;
    c.header.latitude_deg = 60;
    c.header.longitude_deg = -149;
  }
  EXPECT_FALSE(station_place(*read_station(columns), columns, 0, plan, why)->x_m)
      << "one place for all is the station's";
  columns[1].header.longitude_deg = -149 + 30 / (111'195 * 0.5);
  at = station_place(*read_station(columns), columns, 1, plan, why);
  EXPECT_NEAR(*at->x_m, 30, 1e-3);
  columns[1].header.longitude_deg = -140;
  EXPECT_FALSE(station_place(*read_station(columns), columns, 1, plan, why)->x_m)
      << "no building is that long";
}

TEST(StationLayout, AsksForDataThatHeadersLack) {
  std::vector<ChannelColumn> columns = {column("Ground floor", 0), column("somewhere", 0),
                                        column("5th floor", 0), column("Roof", 0)};
  columns[3].header.azimuth_deg.reset();
  columns[3].header.elevation_deg.reset();
  const auto reading = read_station(columns);
  StationPlan plan;
  plan.stories = 3;
  std::string why;
  EXPECT_FALSE(station_place(*reading, columns, 1, plan, why));
  EXPECT_EQ(why, "its header does not say the level");
  EXPECT_FALSE(station_place(*reading, columns, 2, plan, why = ""));
  EXPECT_EQ(why, "its header says floor 5, which is above the roof of 3 stories");
  EXPECT_FALSE(station_place(*reading, columns, 3, plan, why = ""));
  EXPECT_EQ(why, "its header does not say the direction");
  StationPlace known;
  known.azimuth_deg = 0;
  known.along = 'y';
  EXPECT_EQ(parse_station_place("roof", known, plan)->story, 3);
  EXPECT_EQ(parse_station_place("2:x", known, plan)->along, 'x');
  EXPECT_EQ(parse_station_place("unused", known, plan)->why_unused, "as answered");
  for (const char* none : {"4", "-1", "2:w", "", "roof:", "2:xx"})
    EXPECT_FALSE(parse_station_place(none, known, plan)) << none;
  EXPECT_FALSE(read_station({column("somewhere", 0)}));
}

class StationInit : public testing::Test {
 protected:
  ShellResult shell(const std::string& line) { return test::shell(directory_, line); }
  /// Writes a file of one channel on a floor, with this azimuth.
  void station_file(int number, const std::string& place, const std::string& azimuth) {
    test::CosmosChannel channel;
    channel.number = number;
    channel.azimuth = azimuth;
    channel.comment = fmt::format("|<SCNL>8040.HN{}.NP.{:02}\n", number % 2 ? "N" : "E", number);
    std::string text = test::cosmos(channel);
    const std::string usual = "Basement NW corner";
    text.replace(text.find(usual), usual.size(), place);
    test::write_file(directory_.path(fmt::format("{:02}.V1c", number)), text);
  }

  test::TemporaryDirectory directory_;
};

TEST_F(StationInit, WritesWhatCheckAccepts) {
  station_file(1, "Ground floor", "180");  // to a reference of 180
  station_file(3, "Roof W side", "180");
  station_file(5, "Roof E side", "180");
  station_file(7, "Free field", "180");
  station_file(9, "Basement", "400");
  const std::string line =
      "$F init --record *.V1c --stories 3 --plan 24x12 --heights 3.5 --mass 90t";
  const ShellResult said = shell(line);
  EXPECT_EQ(said.status, 0) << said.err;
  const std::string written = test::read_file(directory_.path("building.toml"));
  for (const char* part :
       {"azimuth_y_deg = 0", "floor = \"rigid\"",
        "name = \"NP.8040.05.HNN\"\nstory = 3  # Roof E side\n"
        "azimuth_deg = 0  # along y\nx_m = 24\n",
        "use = false  # not in the building", "direction = \"z\"\nuse = false  # below the base"})
    EXPECT_NE(written.find(part), std::string::npos) << part << "\n" << written;
  EXPECT_NE(said.out.find("framewatch convert FILES station.lcmlog"), std::string::npos)
      << said.out;
  const ShellResult check = shell("$F check building.toml");
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_EQ(shell("$F convert *.V1c station.lcmlog --config building.toml").status, 0);
  EXPECT_EQ(shell("rm building.toml; $F init --record '*.V1c' --stories 3 --plan 24x12 "
                  "--heights 3.5 --mass 90t")
                .status,
            0);
}

TEST_F(StationInit, AsksForMissingPlacesByChannelName) {
  station_file(1, "Ground floor", "180");
  station_file(3, "somewhere W", "180");
  station_file(5, "Roof E side", "180");
  const std::string line = "$F init --record *.V1c --stories 3 --heights 3.5 --mass 90t ";
  ShellResult said = shell(line);
  EXPECT_EQ(said.status, kBadInput);
  EXPECT_NE(said.err.find("--plan: is missing"), std::string::npos) << said.err;
  said = shell(line + "--plan 24x12");
  EXPECT_NE(said.err.find("--channel NP.8040.03.HNN=PLACE: is missing: Where is NP.8040.03.HNN "
                          "(somewhere W)? its header does not say the level."),
            std::string::npos)
      << said.err;
  for (const char* wrong : {"NP.8040.03.HNN=4", "nobody=2", "NP.8040.03.HNN"}) {
    said = shell(line + "--plan 24x12 --channel " + wrong);
    EXPECT_EQ(said.status, kBadInput);
    EXPECT_NE(said.err.find(std::string(wrong) + ": "), std::string::npos) << said.err;
  }
  for (const char* wrong : {"24", "24x", "-1x2", "24x12x3", "axb"})
    EXPECT_NE(shell(line + "--plan " + wrong).err.find("such as 40x25"), std::string::npos)
        << wrong;
  EXPECT_EQ(shell(line + "--plan 24x12 --channel NP.8040.03.HNN=2").status, 0);
}

/// The station of 53 channels of the hand-written configuration configs/atwood_np8040.toml.
TEST_F(StationInit, MatchesTheHandWrittenAtwoodBuilding) {
  FRAMEWATCH_DATA_OR_SKIP(folder, "atwood_np8040_anchorage2018");
  const ShellResult said =
      shell(fmt::format("$F init --record {}/*.V1c.gz --stories 20 --plan 39.6x39.6 --heights 4 "
                        "--mass 1000t --start 0.45Hz --quiet",
                        folder));
  ASSERT_EQ(said.status, 0) << said.err;
  const std::string written = test::read_file(directory_.path("building.toml"));
  const auto count = [&](const std::string& text) {
    int n = 0;
    for (std::size_t at = 0; (at = written.find(text, at)) != std::string::npos; ++at) ++n;
    return n;
  };
  EXPECT_EQ(count("\n[[channel]]\n"), 52);
  EXPECT_EQ(count("use = false"), 25) << "basement and borehole";
  for (const char* part :
       {"name = \"NP.8040.13.HNN\"\nstory = 6  # 7th fl E side\nazimuth_deg = 0",
        "name = \"NP.8040.32.HNE\"\nstory = 20  # Roof E side\nazimuth_deg = 90"})
    EXPECT_NE(written.find(part), std::string::npos) << part;
  const ShellResult check = shell("$F check building.toml");
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_NE(check.out.find("kx_14to18"), std::string::npos) << check.out;
}

}  // namespace station_init_test
}  // namespace framewatch::daemon
