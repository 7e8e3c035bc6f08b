// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <fmt/core.h>

namespace framewatch::test {

struct XmlChannel {
  std::string network = "XX", station = "TEST", location = "01", code = "HN1";
  std::string start = "2017-01-01T00:00:00", end;
  std::string place = "7th floor &amp; E side", azimuth = "20", dip = "0", rate = "100";
  std::string sensitivity = "426667", unit = "M/S**2";
};

/// Returns a StationXML file of these channels, one station each. The first station's element is
/// on line 6, its azimuth on 10, its sensitivity on 15.
inline std::string station_xml(const std::vector<XmlChannel>& channels) {
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<FDSNStationXML xmlns=\"http://www.fdsn.org/xml/station/1\" schemaVersion=\"1.1\">\n"
      " <Source>test</Source>\n";
  for (const XmlChannel& c : channels) {
    out += fmt::format(" <Network code=\"{}\">\n  <Station code=\"{}\">\n", c.network, c.station);
    out += fmt::format("   <Channel code=\"{}\" locationCode=\"{}\" startDate=\"{}\"{}>\n", c.code,
                       c.location, c.start,
                       c.end.empty() ? "" : fmt::format(" endDate=\"{}\"", c.end));
    out += fmt::format("    <Description>{}</Description>\n", c.place);
    out += "    <Latitude unit=\"DEGREES\">61.2135</Latitude>\n";
    out += "    <Longitude>-149.8933</Longitude>\n";
    out += fmt::format("    <Azimuth>{}</Azimuth>\n    <Dip>{}</Dip>\n", c.azimuth, c.dip);
    out += fmt::format("    <SampleRate>{}</SampleRate>\n    <Response>\n", c.rate);
    out += fmt::format("     <InstrumentSensitivity>\n      <Value>{}</Value>\n", c.sensitivity);
    out += fmt::format("      <InputUnits><Name>{}</Name></InputUnits>\n", c.unit);
    out +=
        "      <OutputUnits><Name>count</Name></OutputUnits>\n     </InstrumentSensitivity>\n"
        "     <Stage number=\"1\"/>\n    </Response>\n   </Channel>\n  </Station>\n </Network>\n";
  }
  return out + "</FDSNStationXML>\n";
}

}  // namespace framewatch::test
