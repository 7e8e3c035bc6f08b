// SPDX-License-Identifier: MIT
// The places of instruments in the words of networks.
#include <gtest/gtest.h>

#include "drivers/stations/station_words.h"

namespace framewatch::drivers {
namespace station_words_test {

AxisHeader at(const char* place) {
  AxisHeader out;
  out.place = place;
  return out;
}

TEST(StationWords, Levels) {
  struct Case {
    const char* place;
    Level level;
  };
  const Case cases[] = {
      {"7th fl E side", {LevelKind::floor, 7}},
      {"1st fl W side", {LevelKind::floor, 1}},
      {"Roof W side", {LevelKind::roof, 0}},
      {"Basement NW corner", {LevelKind::basement, 0}},
      {"DH array surface", {LevelKind::outside, 0}},
      {"DH array 61.0m", {LevelKind::outside, 0}},
      {"Free Field", {LevelKind::outside, 0}},
      {"Ground floor, center", {LevelKind::floor, 1}},
      {"Level 12 N", {LevelKind::floor, 12}},
      {"Fl. 3 East end", {LevelKind::floor, 3}},
      {"3F", {LevelKind::floor, 3}},
      {"RF", {LevelKind::roof, 0}},
      {"B1F", {LevelKind::basement, 0}},
      {"2nd Floor - SW", {LevelKind::floor, 2}},
      {"floor 6", {LevelKind::floor, 6}},
      {"12 fl", {LevelKind::floor, 12}},
      {"Penthouse", {LevelKind::outside, 0}},
      {"Bay 3", {}},
      {"", {}},
      {"1000th floor", {}},
      {"99999999999999999999th fl", {}},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(level_text(level_of(at(c.place))), level_text(c.level)) << c.place;
    EXPECT_EQ(level_of(at(c.place)), c.level) << c.place;
  }
  AxisHeader numbered;
  numbered.floor = 4;
  EXPECT_EQ(level_of(numbered), (Level{LevelKind::floor, 4}));
  numbered.floor = -1;
  EXPECT_EQ(level_of(numbered), Level{});
}

TEST(StationWords, Sides) {
  EXPECT_EQ(side_of(at("7th fl E side")), (Side{1, 0}));
  EXPECT_EQ(side_of(at("Basement NW corner")), (Side{-1, 1}));
  EXPECT_EQ(side_of(at("Roof, south wall, W end")), (Side{-1, -1}));
  EXPECT_EQ(side_of(at("Roof center")), Side{});
  EXPECT_EQ(side_of(at("between N and S frames")), Side{});
  EXPECT_EQ(side_of(at("7th floor")), Side{});
}

}  // namespace station_words_test
}  // namespace framewatch::drivers
