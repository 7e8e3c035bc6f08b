#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record_options.h"
#include "drivers/stations/station_xml.h"

namespace framewatch::drivers {

/// What the numbers of one channel are.
struct CountMeaning {
  double unit_mps2 = 1;  ///< of one; negative where the sensor reads backwards
  AxisHeader header;
  std::string note;  ///< for a person; empty: it was declared
};

/// What the numbers of a file are that does not say it: declared by a person, or in the StationXML
/// of its network.
class CountMeanings {
 public:
  /// Empty, with every problem, when the StationXML cannot be read.
  static std::optional<CountMeanings> read(const RecordOptions& options, FileProblems& problems);

  /// Of a channel whose first sample is of that time. Empty, with a problem, when the StationXML
  /// does not have the channel at that time, or not as an accelerometer with a sensitivity.
  std::optional<CountMeaning> of(const std::string& channel, std::optional<double> start_utc_s,
                                 double rate_hz, FileProblems& problems) const;

 private:
  std::optional<double> declared_mps2_;
  std::string path_;
  std::vector<StationXmlChannel> channels_;
};

}  // namespace framewatch::drivers
