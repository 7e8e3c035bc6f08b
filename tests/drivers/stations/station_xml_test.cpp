// SPDX-License-Identifier: MIT
// StationXML and what it says about the numbers in a miniSEED or SAC file.
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "drivers/stations/station_xml.h"
#include "tests/support/miniseed.h"
#include "tests/support/station_files.h"
#include "tests/support/station_xml.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace station_xml_test {

using test::station_xml;
using test::XmlChannel;

constexpr std::int64_t kStart_us = 1'795'478'400'000'000;  // 2026-11-24
constexpr double kSensitivity = 426'667;

class StationXml : public testing::Test {
 protected:
  StationXml() { options_.station_xml = xml_; }
  std::optional<std::vector<StationXmlChannel>> parse(const std::string& text) {
    test::write_file(xml_, text);
    problems_.clear();
    return read_station_xml(xml_, problems_);
  }
  std::optional<Record> read(const std::string& xml, const std::string& bytes) {
    test::write_file(xml_, xml);
    test::write_file(data_, bytes);
    problems_.clear();
    return read_record(data_, options_, problems_);
  }
  void expect_refused(const std::string& text, int line, const std::string& rule) {
    SCOPED_TRACE(rule);
    EXPECT_FALSE(parse(text));
    ASSERT_FALSE(problems_.empty());
    EXPECT_EQ(problems_[0].where, line > 0 ? fmt::format("{}:{}", xml_, line) : xml_);
    EXPECT_NE(problems_[0].message.find(rule), std::string::npos) << problems_[0].message;
  }
  void expect_said(const std::string& part) const {
    std::string all;
    for (const Problem& p : problems_) all += p.message + "\n";
    EXPECT_NE(all.find(part), std::string::npos) << "not said: " << part << "\nbut " << all;
  }

  static test::SeedSpan span() {
    test::SeedSpan out;
    out.start_us = kStart_us;
    out.values = {1, -2, 3, 400};
    return out;
  }

  test::TemporaryDirectory directory_;
  const std::string xml_ = directory_.path("station.xml"), data_ = directory_.path("quake");
  RecordOptions options_;
  std::vector<Problem> problems_;
};

TEST_F(StationXml, GivesSensitivityAndPlaceOfAChannel) {
  XmlChannel other;
  other.code = "HN2";
  other.azimuth = "-90";
  other.unit = "cm/s**2";
  XmlChannel up;
  up.code = "HNZ";
  up.dip = "-90";
  test::SeedSpan second = span(), third = span();
  second.channel = "HN2";
  third.channel = "HNZ";
  const auto r =
      read(station_xml({{}, other, up}), miniseed(span()) + miniseed(second) + miniseed(third));
  ASSERT_TRUE(r) << problems_[0].where << problems_[0].message;
  ASSERT_EQ(r->headers.size(), 3U);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][3], 400 / kSensitivity);
  EXPECT_DOUBLE_EQ(r->accel_mps2[1][1], -2 * 0.01 / kSensitivity);
  EXPECT_EQ(r->headers[0].azimuth_deg, 20);
  EXPECT_EQ(r->headers[0].place, "7th floor & E side");
  EXPECT_EQ(r->headers[0].latitude_deg, 61.2135);
  EXPECT_EQ(r->headers[0].unit, "count");
  EXPECT_EQ(r->headers[1].azimuth_deg, -90);
  EXPECT_TRUE(is_vertical(r->headers[2]));
  EXPECT_EQ(direction_text(r->headers[2]), "up");
  const auto said = [&](const std::string& words) {
    for (const std::string& note : r->notes)
      if (note.find(words) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(
      said("XX.TEST.01.HN1: azimuth 20 deg, 7th floor & E side, 2.34375e-06 m/s2 per count"));
  EXPECT_TRUE(said("not used: the response's stages, elevation, depth"));
}

TEST_F(StationXml, KnowsTheUnitsOfOtherNetworks) {
  for (const auto& [unit, mps2] :
       {std::pair{"NM/S**2", 1e-9}, std::pair{"nm/s^2", 1e-9}, std::pair{"UM/S/S", 1e-6},
        std::pair{"M/(S**2)", 1.0}, std::pair{"m s**-2", 1.0}}) {
    XmlChannel channel;
    channel.unit = unit;
    const auto record = read(station_xml({channel}), miniseed(span()));
    ASSERT_TRUE(record) << unit;
    EXPECT_DOUBLE_EQ(record->accel_mps2[0][3], 400 * mps2 / kSensitivity) << unit;
  }
}

TEST_F(StationXml, IgnoresOtherEpochs) {
  XmlChannel before, after;
  before.sensitivity = "1000";
  before.end = "2026-11-24T00:00:00";
  after.start = "2026-11-24T00:00:00.000Z";
  const auto r = read(station_xml({before, after}), miniseed(span()));
  ASSERT_TRUE(r);
  EXPECT_DOUBLE_EQ(r->accel_mps2[0][0], 1 / kSensitivity);
  after.start = "2026-11-24T02:00:00+01:00";
  EXPECT_FALSE(read(station_xml({before, after}), miniseed(span())));
  expect_said("station.xml: has XX.TEST.01.HN1, but not at the time of the record");
  EXPECT_FALSE(read(station_xml({{}, {}}), miniseed(span())));
  expect_said("two epochs of XX.TEST.01.HN1 at that time, on lines 6 and ");
}

TEST_F(StationXml, ReportsARateThatDiffersFromTheRecords) {
  XmlChannel slow;
  slow.rate = "50";
  const auto r = read(station_xml({slow}), miniseed(span()));
  ASSERT_TRUE(r);
  EXPECT_NE(r->notes[0].find("StationXML says 50 Hz, the record 100 Hz"), std::string::npos)
      << r->notes[0];
}

TEST_F(StationXml, RefusesADocumentWithoutSensitivity) {
  XmlChannel c;
  c.code = "HN9";
  EXPECT_FALSE(read(station_xml({c}), miniseed(span())));
  expect_said("has no channel XX.TEST.01.HN1");
  c = {};
  c.unit = "M/S";
  EXPECT_FALSE(read(station_xml({c}), miniseed(span())));
  expect_said("measures \"M/S\", which is not a known unit of acceleration");
  c = {};
  c.sensitivity = "0";
  EXPECT_FALSE(read(station_xml({c}), miniseed(span())));
  expect_said("has no InstrumentSensitivity");
  options_.unit_mps2 = 1;
  EXPECT_FALSE(read(station_xml({{}}), miniseed(span())));
  expect_said("--unit and --station-xml both say");
  options_.unit_mps2.reset();
  EXPECT_FALSE(read(station_xml({{}}), "time_s,a\n0,1\n0.01,2\n"));
  options_.station_xml = directory_.path("none.xml");
  EXPECT_FALSE(read(station_xml({{}}), miniseed(span())));
  expect_said("none.xml");
}

TEST_F(StationXml, AppliesToSacToo) {
  XmlChannel c;
  c.network = "NP";
  c.station = "8040";
  c.location = "";
  c.code = "HNE";
  const auto r = read(station_xml({c}), test::sac());
  ASSERT_TRUE(r) << problems_[0].message;
  EXPECT_NEAR(r->accel_mps2[0][1], -2 / kSensitivity, 1e-15);
  EXPECT_EQ(r->headers[0].azimuth_deg, 20);
}

TEST_F(StationXml, RefusesADamagedDocument) {
  const std::string good = station_xml({{}});
  ASSERT_TRUE(parse(good));
  expect_refused(good.substr(0, good.size() - 20), 23, "is not XML");
  expect_refused("", 1, "is not XML");
  expect_refused("<html><body/></html>", 1, "its root element is \"html\"");
  expect_refused("<FDSNStationXML/>", 0, "has no channel");
  XmlChannel c;
  c.azimuth = "north";
  expect_refused(station_xml({c}), 10, "Azimuth \"north\" is not a number from -360 to 360");
  c = {};
  c.azimuth = "361";
  expect_refused(station_xml({c}), 10, "Azimuth \"361\"");
  c = {};
  c.dip = "nan";
  expect_refused(station_xml({c}), 11, "Dip \"nan\"");
  c = {};
  c.sensitivity = "1e400";
  expect_refused(station_xml({c}), 15, "InstrumentSensitivity");
  c = {};
  c.start = "yesterday";
  expect_refused(station_xml({c}), 6, "\"yesterday\" is not a time");
  std::string deep = "<FDSNStationXML>";
  for (int i = 0; i < 40; ++i) deep += "<a>";
  expect_refused(deep, 1, "nested more than 32 deep");
}

/// A document type is refused, so no files are read and no entities are expanded.
TEST_F(StationXml, RefusesADocumentType) {
  const std::string good = station_xml({{}});
  const std::size_t root = good.find("<FDSN");
  test::write_file(directory_.path("secret"), "20");
  for (const std::string& type :
       {std::string("<!DOCTYPE FDSNStationXML [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b "
                    "\"&a;&a;&a;&a;&a;&a;&a;&a;\"><!ENTITY c \"&b;&b;&b;&b;&b;&b;\">]>\n"),
        fmt::format("<!DOCTYPE FDSNStationXML [<!ENTITY x SYSTEM \"file://{}\">]>\n",
                    directory_.path("secret")),
        std::string("<!DOCTYPE FDSNStationXML SYSTEM \"http://127.0.0.1/x.dtd\">\n")})
    expect_refused(good.substr(0, root) + type + good.substr(root), 2, "has a document type");
  std::string undefined = good;
  undefined.replace(undefined.find("&amp;"), 5, "&who;");
  expect_refused(undefined, 7, "is not XML: undefined entity");
}

TEST_F(StationXml, TakesBoundedMemoryForAnyLength) {
  std::string long_text(3'000'000, 'x');
  XmlChannel c;
  c.place = long_text;
  const auto channels = parse(station_xml({c}));
  ASSERT_TRUE(channels);
  EXPECT_LE(channels->front().header.place.size(), 1000U);
  std::string endless = "<FDSNStationXML>";
  endless += std::string(std::size_t{65} << 20, ' ');
  expect_refused(endless, 0, "is longer than 64 MiB");
}

}  // namespace station_xml_test
}  // namespace framewatch::drivers
