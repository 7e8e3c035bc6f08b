// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/lab/reproduction.h"

namespace framewatch::daemon {

/// Plots given and identified parameters without noise, one plot per kind: Figures 3 and 5.
std::vector<std::string> given_and_identified(const BuildingReproduction& building);

/// Plots median errors of k, G and c by every method, and the least possible ones.
std::vector<std::string> median_errors(const std::vector<const AccuracyRow*>& rows);

/// Plots identified over given against noise level, one line per parameter, one plot per group.
/// damping: include that of frames and floors (Figure 6; Figure 7 has stiffness only).
std::vector<std::string> noise_influence(const NoiseSweep& sweep,
                                         const std::vector<Eigen::VectorXd>& ratio,
                                         const std::string& method, int color, bool damping);

/// Plots the shares of parameters published, and published wrong, against noise level.
std::string excitation_plot(const ExcitationSweep& sweep);

/// Draws boxplots of the stiffnesses of one stage by every method, frames and floors: Figure 10.
std::vector<std::string> stage_boxes(const TableTest& test, const TableStage& stage);

}  // namespace framewatch::daemon
