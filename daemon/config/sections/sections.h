// SPDX-License-Identifier: MIT
#pragma once

// Readers of the sections of a configuration.

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Design parameters of a valid structure.
struct DesignReading {
  Eigen::VectorXd theta;  ///< parameters of every story; empty without a design
  estimator::BendingStiffness bending_nmprad{};
};

/// [structure] and [structure.design] as far as they could be read.
struct StructureReading {
  estimator::Structure structure;
  DesignReading design;
  std::optional<double> azimuth_y_deg;
  std::vector<int> group_floors;
  double mass_tolerance = 0, profile_tolerance = 0;  ///< relative
  bool stories_known = false;
  bool frames_known = false;
};

StructureReading read_structure(const TomlValue& document, std::vector<TextProblem>& problems);

/// Returns the rule that a frame or channel name breaks, or an empty text.
std::string problem_of_name(const std::string& name);

/// Reads every [[channel]] into config.pipeline.axes and config.sources.
void read_channels(const TomlValue& document, const StructureReading& structure, Config& config,
                   std::vector<TextProblem>& problems);

/// Reads [[can]], [[can_node]] and the sources of the channels into config.can. Reports problems of
/// a DBC file at their place in it, those of messages only if the channels need them. Sets
/// config.doubts.
void read_can(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

estimator::EstimatorOptions read_estimator(const TomlValue& document,
                                           std::vector<TextProblem>& problems);
LcmSettings read_lcm(const TomlValue& document, std::vector<TextProblem>& problems);
CommandSettings read_commands(const TomlValue& document, std::vector<TextProblem>& problems);
std::optional<WatchSettings> read_watch(const TomlValue& document,
                                        std::vector<TextProblem>& problems);
/// Reads every [[weather]]. `config` has the sources of channels.
std::vector<WeatherSettings> read_weather_tables(const TomlValue& document, const Config& config,
                                                 std::vector<TextProblem>& problems);
/// Reads [mqtt]. `config` has the covariates; adds a doubt to config.doubts if a password would
/// cross the network unencrypted.
std::optional<drivers::MqttSettings> read_mqtt(const TomlValue& document, Config& config,
                                               std::vector<TextProblem>& problems);
/// Adds the covariate temperature_degc for the thermometer of [watch] unless [[weather]] names it.
void add_thermometer(Config& config);
std::optional<GapSettings> read_gap(const TomlValue& document, std::vector<TextProblem>& problems);
std::optional<HistorySettings> read_history(const TomlValue& document,
                                            std::vector<TextProblem>& problems);
std::optional<EventReportSettings> read_event_report(const TomlValue& document,
                                                     std::vector<TextProblem>& problems);
/// `stories`: number of stories, or 0 if unknown.
std::optional<FragilitySettings> read_fragility(const TomlValue& document, int stories,
                                                std::vector<TextProblem>& problems);
/// Reads [email], and [actions] and [report], which may use it, into `config`.
void read_notifications(const TomlValue& document, Config& config,
                        std::vector<TextProblem>& problems);
/// `has_history`: true if [history] exists; messages for the hub wait there.
std::optional<FleetSettings> read_fleet(const TomlValue& document, bool has_history,
                                        std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
