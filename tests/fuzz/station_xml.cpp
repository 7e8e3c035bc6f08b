// SPDX-License-Identifier: MIT
// StationXML: its elements, and the calibration read from them for a record's channel.
#include <cmath>
#include <string>
#include <vector>

#include "drivers/stations/station_words.h"
#include "drivers/stations/station_xml.h"
#include "tests/fuzz/scratch.h"
#include "tests/fuzz/targets.h"
#include "tests/support/station_xml.h"

namespace framewatch::test {
namespace {

void read_station_metadata(Bytes input) {
  const InputFile file(input);
  std::vector<drivers::Problem> problems;
  const auto channels = drivers::read_station_xml(file.path(), problems);
  require(channels.has_value() == problems.empty(), "channels or a problem");
  if (!channels) return;
  require(!channels->empty(), "a channel at least");
  for (const drivers::StationXmlChannel& channel : *channels) {
    std::string why;
    const auto unit_mps2 = drivers::mps2_per_count(channel, why);
    require(unit_mps2.has_value() == why.empty(), "a unit or a reason");
    require(!unit_mps2 || (*unit_mps2 != 0 && !std::isnan(*unit_mps2)), "a unit that is one");
    const double at_utc_s = channel.start_utc_s.value_or(0);
    why.clear();
    const auto* found = drivers::channel_at(*channels, channel.name, at_utc_s, why);
    require((found != nullptr) == why.empty(), "one epoch or a reason");
    const drivers::Level level = drivers::level_of(channel.header);
    require((level.number > 0) == (level.kind == drivers::LevelKind::floor), "a number of a floor");
    (void)drivers::side_of(channel.header);
  }
}

std::vector<std::string> station_xml_seeds() {
  XmlChannel up, other;
  up.dip = "-90";
  up.place = "Roof NW corner";
  other.start = "2018-11-30T17:29:06.5+09:00";
  other.end = "2599-12-31T23:59:59Z";
  other.place = "B1F &#x41; <![CDATA[3rd fl]]>";
  other.unit = "cm/s**2";
  std::string prefixed = station_xml({{}});
  for (std::size_t at = 0; (at = prefixed.find("<Channel", at)) != std::string::npos; at += 9)
    prefixed.insert(at + 1, "a:");
  return {station_xml({{}}), station_xml({up, other}), prefixed,
          "<?xml version=\"1.0\"?><!DOCTYPE FDSNStationXML [<!ENTITY a \"b\">]><FDSNStationXML/>"};
}

}  // namespace

const FuzzTarget kStationXmlTarget{"stationxml", &read_station_metadata, &station_xml_seeds};

}  // namespace framewatch::test
