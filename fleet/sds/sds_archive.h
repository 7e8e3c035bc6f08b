// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace framewatch::fleet {

/// The codes of a building in an archive. They replace the codes in its records.
struct SdsCodes {
  std::string network;  ///< 1 or 2 of A-Z and 0-9
  std::string station;  ///< 1 to 5 of A-Z and 0-9
};
bool is_network_code(const std::string& code);
bool is_station_code(const std::string& code);

/// The result of add_to_sds().
struct SdsOutcome {
  std::vector<std::string> files;  ///< replaced files, all complete
  std::int64_t samples = 0;        ///< number of new samples
  std::string problem;             ///< why it stopped; empty on success
};

/// Adds miniSEED 2 records of integers to an SDS archive (SeisComP data structure),
/// ROOT/YEAR/NET/STA/CHAN.D/NET.STA.LOC.CHAN.D.YEAR.DAY, one file for each channel and UTC day.
/// Merges new samples with an existing file by time and replaces the file atomically, so that
/// adding the same records twice changes nothing. Of two values at one time the first stays.
SdsOutcome add_to_sds(const std::string& root, std::span<const std::uint8_t> miniseed,
                      const SdsCodes& codes);

}  // namespace framewatch::fleet
