// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/record_file_arguments.h"
#include "daemon/config/config.h"

namespace framewatch::daemon {

/// Calibrated samples of a whole session, evenly spaced.
struct SessionMotion {
  double rate_hz = 0;
  std::int64_t first_us = 0;                ///< sensor time of row 0
  std::vector<estimator::SensorAxis> axes;  ///< columns
  Eigen::MatrixXd accel;                    ///< instants x axes, m/s^2, absolute; NaN where missing
  std::vector<std::string> notes;

  std::int64_t time_us(Eigen::Index row) const;
  /// Returns the first row at or after a sensor time, at most rows().
  Eigen::Index row_at(std::int64_t time_us) const;
};

/// Reads raw samples (logs and record files, in order of time) as the estimator would see them.
/// Damaged parts are skipped and noted. declared: options that record files do not state
/// themselves. Returns nullopt and adds to `problems` when they do not fit the configuration.
std::optional<SessionMotion> read_session_motion(const Config& config,
                                                 const std::vector<std::string>& paths,
                                                 std::vector<std::string>& problems,
                                                 const RecordFileArguments& declared = {});

/// quiet: nothing moves; forced: the base moves; free: the base rests and the building still moves.
enum class StageKind { quiet, forced, free };
const char* stage_word(StageKind kind);

struct Stage {
  StageKind kind;
  std::int64_t from_us, to_us;  ///< sensor time
  double seconds() const { return 1e-6 * static_cast<double>(to_us - from_us); }
};

/// Divides the session, from its first to its last sample, into stages of at least a second. Base
/// or floors move while the rms of half a second, without its mean, exceeds four times the sensors'
/// noise and 2 % (base) or 1 % (floors) of the strongest motion of the session.
std::vector<Stage> find_stages(const SessionMotion& motion);

}  // namespace framewatch::daemon
