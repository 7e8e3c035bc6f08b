// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/tools/lab/reproduction.h"

namespace framewatch::daemon {

/// Returns as HTML the command that repeats one part of the report. name: of the case; empty: all.
std::string command_html(const std::string& name, int seeds);
/// Returns rows of the accuracy table with every method.
std::string row_table(const std::vector<const AccuracyRow*>& rows);
/// Adds the median errors of every method except `matched`.
void add_other_medians(const AccuracyRow& row, int kind, std::vector<std::string>& cells);

/// Return the rows of the tables of silence, few sensors and wrong models, as plain text.
std::vector<std::vector<std::string>> silence_rows(const std::vector<Silence>& silences);
std::vector<std::vector<std::string>> few_sensors_rows(const std::vector<FewSensorsRow>& rows);
std::vector<std::vector<std::string>> wrong_model_rows(const std::vector<FewSensorsRow>& rows);

/// Has Figure 3 or 5, the building's rows and every parameter of its first motion.
std::string building_section(const BuildingReproduction& building, const Reproduction& all);
/// Have Figures 6 and 7. Precondition: all.noise, all.denoise.
std::string noise_section(const Reproduction& all);
std::string denoise_section(const Reproduction& all);
/// Has Figure 10 with its numbers.
std::string table_section(const TableTest& test);
/// Has the accuracy with sensors on few floors, and with models that are wrong.
std::string few_sensors_section(const Reproduction& all);
/// Has fading excitation, silence, bias and random buildings.
std::string robustness_section(const Robustness& robustness, int seeds);

}  // namespace framewatch::daemon
