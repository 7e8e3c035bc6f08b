#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {

/// One channel of an export.
struct RawChannel {
  std::string name;
  drivers::AxisAddress address;  ///< on LCM
  std::size_t number = 0;        ///< among all channels, from 0: the same whichever are exported
};

/// Writes raw samples of a history in the order in which they were received, m/s^2 before
/// calibration.
class RawExport {
 public:
  virtual ~RawExport() = default;
  /// NaN: there was no valid value. False when it cannot be written; error() says why, here and
  /// below.
  [[nodiscard]] virtual bool put(std::size_t channel, std::int64_t time_us, double accel_mps2) = 0;
  /// Other messages than samples, for formats that can store them.
  [[nodiscard]] virtual bool message(const drivers::LogEvent&) { return true; }
  /// The file gets its final name only here.
  [[nodiscard]] virtual bool close() = 0;
  virtual std::string error() const = 0;
  /// Notes about the file for the user, one line each.
  virtual std::vector<std::string> notes() const { return {}; }
};

struct SeedNames {
  std::string network, station;
};

/// By the name's end: .lcmlog (accel_t, as `framewatch replay` reads), .csv and .csv.gz (a record)
/// or .mseed (Steim-2 counts of `resolution_mps2`). Null, and the reason, when it cannot be made.
std::unique_ptr<RawExport> raw_export(const std::string& path,
                                      const std::vector<RawChannel>& channels, double rate_hz,
                                      double resolution_mps2, const SeedNames& names,
                                      std::string& error);

/// The rule that the name of an export breaks; empty when it is valid.
std::string problem_of_raw_name(const std::string& path);

}  // namespace framewatch::daemon
