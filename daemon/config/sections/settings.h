// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/keys/action_options.h"
#include "daemon/config/keys/channel_options.h"
#include "daemon/config/keys/event_report_options.h"
#include "daemon/config/keys/fleet_options.h"
#include "daemon/config/keys/history_options.h"
#include "daemon/config/keys/lcm_options.h"
#include "daemon/config/keys/watch_options.h"
#include "daemon/config/keys/weather_options.h"
#include "daemon/config/sections/config_problems.h"
#include "drivers/can/can_map.h"
#include "drivers/mqtt/mqtt_settings.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// A channel that the estimation does not use.
struct UnusedChannel {
  std::string name, reason;
};

/// One configuration file with defaults filled in.
struct Config {
  std::string path;
  std::string sha256;
  /// SHA-256 of the values of each section, by its name ("channel" covers all channels).
  std::map<std::string, std::string> section_sha256;
  estimator::PipelineConfig pipeline;
  std::vector<AxisSource> sources;  ///< parallel to pipeline.axes
  std::vector<UnusedChannel> unused;
  std::optional<double> azimuth_y_deg;  ///< direction of the plan's y axis, clockwise from north
  LcmSettings lcm;
  CommandSettings commands;
  drivers::CanMap can;                              ///< axes as in pipeline.axes
  std::vector<WeatherSettings> weather;             ///< with the thermometer of [watch]
  std::optional<drivers::MqttSettings> mqtt;        ///< without it no covariate has a topic
  std::optional<WatchSettings> watch;               ///< without it nothing is watched
  std::optional<GapSettings> gap;                   ///< without it nothing is simulated
  std::optional<HistorySettings> history;           ///< without it nothing is kept
  std::optional<EventReportSettings> event_report;  ///< without it no report is written
  std::optional<FragilitySettings> fragility;       ///< without it damage is not judged
  std::optional<ActionSettings> actions;            ///< without it no notifications are sent
  std::optional<EmailSettings> email;               ///< without it no e-mail is sent
  std::optional<ReportSettings> report;             ///< without it no monthly report is written
  std::vector<estimator::Effect> effects;           ///< effects beyond the linear model
  std::vector<ConfigProblem> doubts;   ///< warnings about allowed but implausible values
  std::optional<FleetSettings> fleet;  ///< for `framewatch uplink`
};

}  // namespace framewatch::daemon
