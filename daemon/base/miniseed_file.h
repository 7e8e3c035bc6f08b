// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "drivers/files/partial_file.h"

namespace framewatch::daemon {

/// SEED name of a channel: codes of 2, 5, 2 and 3 characters.
struct SeedChannel {
  std::string network, station, location, channel;
};

/// Returns the location code 01, 02, ... and a channel code such as HN1 for channel number `index`
/// from 0: band by rate, N for accelerometer, 1 for an axis of unknown direction.
SeedChannel seed_channel(const std::string& network, const std::string& station, std::size_t index,
                         double rate_hz);

/// Writes integers as miniSEED 2 with Steim-2, records of 512 bytes and times in us. A new record
/// begins where a sample's time differs by half a sample or more from the rate. The file is a
/// PartialFile that close() renames.
class MiniseedFile {
 public:
  MiniseedFile(std::vector<SeedChannel> channels, double rate_hz);
  /// Removes the partial file unless close() was called.
  ~MiniseedFile();
  MiniseedFile(const MiniseedFile&) = delete;
  MiniseedFile& operator=(const MiniseedFile&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool put(std::size_t channel, std::int64_t time_us, std::int32_t count);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }
  /// Returns a name such as "XX.FRAME.01.HN1".
  std::string seed_name(std::size_t channel) const;

 private:
  struct Run {
    std::int64_t start_us = 0;
    std::vector<std::int32_t> counts;
  };
  bool write_run(std::size_t channel);
  void discard();

  std::vector<SeedChannel> channels_;
  double rate_hz_;
  std::vector<Run> runs_;
  drivers::PartialFile partial_;
  std::FILE* file_ = nullptr;
  std::string error_;
};

}  // namespace framewatch::daemon
