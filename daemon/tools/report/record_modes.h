// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "daemon/tools/report/session_motion.h"
#include "estimator/modes/measured_modes.h"
#include "estimator/modes/mode_shapes.h"
#include "estimator/modes/natural_modes.h"
#include "estimator/refine/max_likelihood.h"

namespace framewatch::daemon {

/// One mode as the identified model, the record and the design show it. A list's index is -1 where
/// it does not have the mode. MACs are over the compared channels; NaN without a pair.
struct ModeRow {
  int identified = -1, measured = -1, design = -1;
  double mac_measured = 0;         ///< identified and measured
  double mac_design = 0;           ///< identified and design
  double mac_design_measured = 0;  ///< design and measured
  std::string note;                ///< why something is missing or uncertain; empty: nothing is
};

/// The modes of a building in one stretch of a record.
struct RecordModes {
  double rate_hz = 0;
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time of the stretch
  std::vector<std::string> channels;    ///< at which shapes are compared
  std::vector<std::string> silent;      ///< channels without samples, which were left out
  estimator::Structure structure;
  Eigen::MatrixXd weights;  ///< channels x degrees of freedom: the motion that each measures
  estimator::Refinement refinement;
  estimator::NaturalModes identified, design;
  std::vector<estimator::MeasuredMode> measured;
  /// Why a list is empty; empty if it is not.
  std::string no_identified, no_measured, no_design;
  std::vector<ModeRow> rows;  ///< by ascending frequency
};

/// Returns the modes of the rows from..to-1 of a motion: of the model refined from the stretch, of
/// the record alone, and of the design. Uses the longest part without missing samples, and of a
/// long part the strongest piece that one minute of computing can refine.
/// start: theta of the identified parameters to start from, SI; NaN: the design's value.
RecordModes record_modes(const Config& config, const SessionMotion& motion,
                         const std::vector<double>& start, Eigen::Index from, Eigen::Index to);

/// Returns modes as estimator::mac() and paired_modes() compare them, at the channels of `weights`.
std::vector<estimator::ComparedMode> compared_modes(const estimator::NaturalModes& modes,
                                                    const Eigen::MatrixXd& weights);

/// Returns the words for a mode's motion by NaturalMode::motion: "x", "y + rotation".
std::string motion_words(const estimator::NaturalMode& mode);

/// Returns the name of a degree of freedom: "floor 2, frame y1".
std::string freedom_name(const estimator::Structure& structure, int dof);

}  // namespace framewatch::daemon
