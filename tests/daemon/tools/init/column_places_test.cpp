// SPDX-License-Identifier: MIT
#include "daemon/tools/init/column_places.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace column_places_test {

/// Returns a building with this number of frames along x and y, named as init names them.
estimator::Structure building(int stories, int frames_x, int frames_y) {
  estimator::Structure s;
  s.stories = stories;
  for (int i = 1; i <= frames_x; ++i) s.frames_x.push_back("y" + std::to_string(i));
  for (int i = 1; i <= frames_y; ++i) s.frames_y.push_back("x" + std::to_string(i));
  return s;
}

/// "0:x=base_x 1:y1=- ..."
std::string matched(const estimator::Structure& s, const std::vector<std::string>& titles,
                    std::optional<TitleReading> reading = {}) {
  const ColumnPlaces found = match_columns(s, places_of(s), titles, reading);
  const std::vector<Place> places = places_of(s);
  std::string out;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const auto& column = found.column_of_place[p];
    out += place_option(s, places[p]) + "=" + (column ? titles[*column] : "-") + " ";
  }
  return out + (found.ambiguous ? "? " + titles[*found.ambiguous] : "");
}

TEST(ColumnPlaces, OneSensorPerFloorAndDirection) {
  const auto s = building(2, 1, 1);
  EXPECT_EQ(matched(s, {"base_x", "base_y", "floor1_x", "floor1_y", "roof_x", "roof_y"}),
            "0:x=base_x 0:y=base_y 1:y1=floor1_x 1:x1=floor1_y 2:y1=roof_x 2:x1=roof_y ");
  EXPECT_EQ(matched(s, {"Ground X", "Ground Y", "1st floor x", "1st floor y", "TopX", "TopY"}),
            "0:x=Ground X 0:y=Ground Y 1:y1=1st floor x 1:x1=1st floor y 2:y1=TopX 2:x1=TopY ");
  // Along x and y on floors 0, 1, 2. Nothing else names the floor, so y1 is not a frame.
  EXPECT_EQ(matched(s, {"x0", "y0", "x1", "y1", "x2", "y2"}),
            "0:x=x0 0:y=y0 1:y1=x1 1:x1=y1 2:y1=x2 2:x1=y2 ");
}

TEST(ColumnPlaces, APlaneBuildingNeedsNoDirection) {
  const auto s = building(3, 1, 0);
  EXPECT_EQ(matched(s, {"base", "floor1", "floor2", "floor3"}),
            "0:x=base 1:y1=floor1 2:y1=floor2 3:y1=floor3 ");
  EXPECT_EQ(matched(s, {"ground acc", "level 1", "level 2", "roof"}),
            "0:x=ground acc 1:y1=level 1 2:y1=level 2 3:y1=roof ");
  EXPECT_EQ(matched(s, {"base", "A1Y1", "A2Y1", "A3Y1"}),
            "0:x=base 1:y1=A1Y1 2:y1=A2Y1 3:y1=A3Y1 ");
}

TEST(ColumnPlaces, ALetterWithANumberMeansAFrameOrADirection) {
  const std::vector<std::string> titles{"A0X", "A0Y", "A1Y1", "A1Y2", "A1X1", "A1X2"};
  const auto s = building(1, 2, 2);
  EXPECT_EQ(matched(s, {"base_x", "base_y", "A1Y1", "A1Y2", "A1X1", "A1X2"}),
            "0:x=base_x 0:y=base_y 1:y1=- 1:y2=- 1:x1=- 1:x2=- ? A1Y1");
  EXPECT_EQ(matched(s, {"base_x", "base_y", "A1Y1", "A1Y2", "A1X1", "A1X2"}, TitleReading::frames),
            "0:x=base_x 0:y=base_y 1:y1=A1Y1 1:y2=A1Y2 1:x1=A1X1 1:x2=A1X2 ");
  EXPECT_EQ(
      matched(s, {"base_x", "base_y", "A1Y1", "A1Y2", "A1X1", "A1X2"}, TitleReading::directions),
      "0:x=base_x 0:y=base_y 1:y1=A1X1 1:y2=A1X2 1:x1=A1Y1 1:x2=A1Y2 ");
  // "frame", or the direction beside it, leaves one reading.
  EXPECT_EQ(matched(s, {"base_x", "base_y", "frame y1 story 1", "frame y2 story 1", "x1 story 1 y",
                        "x2 story 1 y"}),
            "0:x=base_x 0:y=base_y 1:y1=frame y1 story 1 1:y2=frame y2 story 1 1:x1=x1 story 1 y "
            "1:x2=x2 story 1 y ");
  EXPECT_EQ(match_columns(s, places_of(s), titles, {}).column_of_place[2], std::nullopt);
}

TEST(ColumnPlaces, TheBuildingDecidesAmbiguousNames) {
  // Three frames along x, two along y: y3 is not a third accelerometer along y.
  EXPECT_EQ(matched(building(1, 3, 2), {"base_x", "base_y", "y1 story 1", "y2 story 1",
                                        "y3 story 1", "x1 story 1", "x2 story 1"}),
            "0:x=base_x 0:y=base_y 1:y1=y1 story 1 1:y2=y2 story 1 1:y3=y3 story 1 "
            "1:x1=x1 story 1 1:x2=x2 story 1 ");
  EXPECT_EQ(
      matched(building(1, 3, 2), {"base_x", "base_y", "F1-Y1", "F1-Y2", "F1-X1", "F1-X2", "F1-X3"}),
      "0:x=base_x 0:y=base_y 1:y1=F1-X1 1:y2=F1-X2 1:y3=F1-X3 1:x1=F1-Y1 1:x2=F1-Y2 ");
}

TEST(ColumnPlaces, ReadsGermanItalianSpanishAndJapaneseTitles) {
  const auto s = building(2, 1, 1);
  const std::vector<std::vector<std::string>> titles{
      {"Fundament X", "Fundament Y", "1. OG X-Richtung", "1.OG Y", "Dach x", "Dach y"},
      {"Rütteltisch_x", "Rütteltisch_y", "Geschoß 1 x", "Geschoß 1 y", "Stockwerk 2 x", "OG2 y"},
      {"EG X", "EG Y", "Beschleunigung Decke 1 x", "1. Etage y", "2. Geschoss x", "Ebene 2 y"},
      {"tavola x", "piano terra y", "1° piano direzione x", "piano 1 y", "copertura x", "Tetto Y"},
      {"fondazione x", "fondazione y", "Livello 1 X", "solaio 1 y", "2° piano x", "sommità y"},
      {"mesa x", "planta baja y", "Piso 1 dirección x", "1er piso y", "azotea x", "techo eje y"},
      {"cimentación X", "suelo Y", "aceleración nivel 1 x", "planta 1 y", "Cubierta X",
       "2do piso y"},
      {"1階X", "1階Y", "2階X方向", "2階Y方向", "屋上X", "屋上Y"},
      {"基礎X", "振動台Y", "２階　Ｘ", "2階床 Y加速度", "3階X", "R階Y"}};
  for (const auto& t : titles)
    EXPECT_EQ(matched(s, t), "0:x=" + t[0] + " 0:y=" + t[1] + " 1:y1=" + t[2] + " 1:x1=" + t[3] +
                                 " 2:y1=" + t[4] + " 2:x1=" + t[5] + " ");
  for (const char* title : {"B1階X", "地下1階X", "0階X", "2階 3階 X", "Decke über EG x", "sótano x",
                            "\xEF\xBC", "\xEF\xBC\x41 x", "階X"})
    EXPECT_EQ(matched(s, {title}), "0:x=- 0:y=- 1:y1=- 1:x1=- 2:y1=- 2:x1=- ") << title;
}

TEST(ColumnPlaces, FewSensorsLeaveNumbersOfDirections) {
  auto s = building(3, 3, 2);
  s.span_y = {4, 4};
  s.span_x = {6};
  std::vector<Place> places;
  for (const int story : {0, 3})
    for (const Place& place : places_on_level(s, story, "xxyz")) places.push_back(place);
  std::string options;
  for (const Place& place : places) options += place_option(s, place) + " ";
  EXPECT_EQ(options, "0@(3,0):x 0@(3,8):x 0:y 0@(3,4):z 3:y1 3:y3 3@(3,4):y 3@(3,4):z ");
  const std::vector<std::string> titles{"base x1", "base x2", "base y", "base z",
                                        "roof x1", "roof x2", "roof y", "roof z"};
  const ColumnPlaces found = match_columns(s, places, titles, {});
  for (std::size_t p = 0; p < places.size(); ++p) EXPECT_EQ(found.column_of_place[p], p) << p;
  for (const Place& place : places) EXPECT_EQ(parse_place(s, place_option(s, place)), place);
}

TEST(ColumnPlaces, LeavesNamesWithoutAPlace) {
  const auto s = building(1, 1, 0);
  // Numbers of sensors, and Japan's 1F, which is the ground floor.
  for (const char* title : {"acc1", "ch1", "1", "1F", "sensor 1", "A1", "temperature", "y1", "z",
                            "floor 2", "floor", "roof floor1", "beschleunigung", ""})
    EXPECT_EQ(matched(s, {title}), "0:x=- 1:y1=- ") << title;
  // Two columns for one place: neither gets it.
  EXPECT_EQ(matched(s, {"base", "ground", "roof"}), "0:x=- 1:y1=roof ");
}

TEST(ColumnPlaces, ReadsBackWrittenPlaces) {
  const auto s = building(3, 2, 1);
  for (const Place& place : places_of(s)) EXPECT_EQ(parse_place(s, place_option(s, place)), place);
  EXPECT_EQ(parse_place(s, "base:x"), (Place{0, -1, estimator::Direction::x}));
  EXPECT_EQ(parse_place(s, "roof:y"), (Place{3, 2, estimator::Direction::y}));
  for (const char* text : {"", "1", "1:", ":x", "4:y1", "1:x", "1:y3", "0:y1", "-1:x", "1:z"})
    EXPECT_EQ(parse_place(s, text), std::nullopt) << text;
}

}  // namespace column_places_test
}  // namespace framewatch::daemon
