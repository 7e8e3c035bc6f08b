#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/axis_header.h"

namespace framewatch::drivers {

/// One epoch of one channel in a StationXML file: what its sensor and recorder were in that time.
struct StationXmlChannel {
  std::string name;                              ///< "NP.8040.01.HNE", as record readers name it
  std::int64_t line = 0;                         ///< of the file, where it begins
  std::optional<double> start_utc_s, end_utc_s;  ///< since 1970; without: from or for ever
  AxisHeader header;
  std::optional<double> rate_hz;
  std::optional<double> sensitivity;  ///< of the file's numbers, per one of input_unit
  std::string input_unit;             ///< "m/s**2"
};

/// The channels of an FDSN StationXML file (schema 1.0 to 1.2), plain or gzip. Empty, with every
/// problem at its line, when it is no whole XML, is none of these, has a document type (so no
/// entity but XML's own five is ever expanded and no other file read), is nested deeper, longer or
/// of more channels than any station's is, or has a number or a time that is none.
std::optional<std::vector<StationXmlChannel>> read_station_xml(const std::string& path,
                                                               std::vector<Problem>& problems);

/// The epoch of a channel at a time; null, with the reason in `why`, when there is not one.
const StationXmlChannel* channel_at(const std::vector<StationXmlChannel>& channels,
                                    std::string_view name, double utc_s, std::string& why);

/// m/s^2 of one of the record's numbers; empty, with the reason in `why`, when the channel has no
/// sensitivity or measures no acceleration.
std::optional<double> mps2_per_count(const StationXmlChannel& channel, std::string& why);

}  // namespace framewatch::drivers
