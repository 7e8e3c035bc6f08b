// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"
#include "drivers/records/record_options.h"

namespace framewatch::drivers {

/// One epoch of one channel in a StationXML file: its sensor and recorder in that time.
struct StationXmlChannel {
  std::string name;                              ///< "NP.8040.01.HNE", as record readers name it
  std::int64_t line = 0;                         ///< line of the file at which it begins
  std::optional<double> start_utc_s, end_utc_s;  ///< since 1970; empty: unlimited
  AxisHeader header;
  std::optional<double> rate_hz;
  std::optional<double> sensitivity;  ///< numbers in the record per unit of input_unit
  std::string input_unit;             ///< "m/s**2"
};

/// Reads the channels of an FDSN StationXML file (schema 1.0 to 1.2), plain or gzip. Returns
/// nullopt and appends every problem with its line when the file is not complete XML, is not
/// StationXML, or has an invalid number or time. Also refuses files that are nested more deeply,
/// are longer, or have more channels than that of any real network. Refuses document types:
/// entities other than the five of XML are never expanded and no other file is read.
std::optional<std::vector<StationXmlChannel>> read_station_xml(const std::string& path,
                                                               std::vector<Problem>& problems);

/// Returns the epoch of a channel at a time since 1970. Returns null and sets `why` when there is
/// no such epoch, or more than one.
const StationXmlChannel* channel_at(const std::vector<StationXmlChannel>& channels,
                                    std::string_view name, double utc_s, std::string& why);

/// Returns the m/s^2 of one count. Returns nullopt and sets `why` when the channel has no
/// sensitivity or does not measure an acceleration.
std::optional<double> mps2_per_count(const StationXmlChannel& channel, std::string& why);

/// Says what the numbers of one channel are.
struct CountMeaning {
  double unit_mps2 = 1;  ///< m/s^2 of one count; negative where the sensor is reversed
  AxisHeader header;
  std::string note;  ///< for a person; empty when the user declared the unit
};

/// Finds what the numbers of a file are when the file does not say it: the user declared it, or the
/// StationXML of the network does.
class CountMeanings {
 public:
  /// Reads options.station_xml, if it is set. Returns nullopt with every problem of that file.
  static std::optional<CountMeanings> read(const RecordOptions& options, FileProblems& problems);

  /// Returns the meaning for a channel by its name, the time of its first sample since 1970 and its
  /// rate. Returns nullopt with a problem when the StationXML does not have that channel at that
  /// time, or does not describe an accelerometer with a sensitivity.
  std::optional<CountMeaning> of(const std::string& channel, std::optional<double> start_utc_s,
                                 double rate_hz, FileProblems& problems) const;

 private:
  std::optional<double> declared_mps2_;
  std::string path_;
  std::vector<StationXmlChannel> channels_;
};

}  // namespace framewatch::drivers
