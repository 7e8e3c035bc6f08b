// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

struct RawChannel {
  std::string name;
  drivers::AxisAddress address;  ///< LCM address
  std::size_t number =
      0;  ///< among all channels, from 0; does not depend on which ones are exported
};

/// Writes raw samples of a history in the order in which they were received, in m/s^2 before
/// calibration. Methods return false on failure; error() says why.
class RawExport {
 public:
  virtual ~RawExport() = default;
  /// Writes a sample; NaN stands for an invalid value.
  [[nodiscard]] virtual bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) = 0;
  /// Writes another message, if the format can store it.
  [[nodiscard]] virtual bool message(const drivers::LogEvent&) { return true; }
  /// Completes the file, which gets its final name only here.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Returns notes about the file for the user, one line each.
  virtual std::vector<std::string> notes() const { return {}; }
};

struct SeedNames {
  std::string network, station;
};

/// Makes an export by the ending of its name: .lcmlog (accel_t, as `framewatch replay` reads), .csv
/// and .csv.gz (a record) or .mseed (Steim-2 counts of `resolution_mps2`). Returns nullptr and sets
/// `error` on failure.
std::unique_ptr<RawExport> raw_export(const std::string& path,
                                      const std::vector<RawChannel>& channels, double rate_hz,
                                      double resolution_mps2, const SeedNames& names,
                                      std::string& error);

/// Returns the rule that the name of an export breaks; empty if the name is valid.
std::string problem_of_raw_name(const std::string& path);

}  // namespace framewatch::daemon
