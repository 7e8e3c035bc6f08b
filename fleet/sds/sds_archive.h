#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace framewatch::fleet {

/// What an archive calls a building: in place of what its records say.
struct SdsCodes {
  std::string network;  ///< 1 or 2 of A-Z and 0-9
  std::string station;  ///< 1 to 5
};
bool is_network_code(const std::string& code);
bool is_station_code(const std::string& code);

/// What add_to_sds() did.
struct SdsOutcome {
  std::vector<std::string> files;  ///< written anew
  std::int64_t samples = 0;        ///< that were not there before
  std::string problem;             ///< empty, or why it stopped; files that are named are whole
};

/// Puts records of miniSEED 2 with integers into the folders of SDS (SeisComP data structure),
/// ROOT/YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY, a file for each channel and day in UTC.
/// What is there already stays: a file is read, joined with what is new by the time of each sample,
/// and replaced as a whole, so that the same stretch again changes nothing. A sample that is there
/// twice with two values keeps the first.
SdsOutcome add_to_sds(const std::string& root, std::span<const std::uint8_t> miniseed,
                      const SdsCodes& codes);

}  // namespace framewatch::fleet
