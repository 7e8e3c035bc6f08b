// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/init/building_plan.h"
#include "daemon/tools/init/channel_columns.h"
#include "daemon/tools/init/column_places.h"
#include "daemon/tools/init/station_layout.h"

namespace framewatch::daemon {

/// The answers as typed, by option or in the dialogue.
struct InitAnswers {
  std::map<std::string, std::string, std::less<>> by_option;  ///< "stories": "3"; files of
                                                              ///< "record" stand one a line
  std::vector<std::string> channels;                          ///< NAME=PLACE
  RecordFileArguments record;                                 ///< what the record does not say
};

/// Files as they were read, by name and options, so that a dialogue reads each once.
class ColumnCache {
 public:
  const ChannelColumns& records(const std::vector<std::string>& paths,
                                const RecordFileArguments& arguments);
  const ChannelColumns& dbc(const std::string& path, const std::string& interface);

 private:
  std::map<std::string, ChannelColumns> read_;
};

/// A building as far as it is answered.
struct BuildingDraft {
  BuildingPlan plan;
  bool has_x = true, has_y = true;  ///< directions that are measured
  bool stories_known = false, bays_known = false;
  RecordFileArguments record_arguments;
  std::string live;                    ///< "lcm", "can" or "none"
  std::vector<ChannelColumn> columns;  ///< that a person named
  std::vector<std::string> notes;      ///< notes to print once
  std::vector<double> mass;            ///< as answered
  std::string mass_unit;               ///< kg, t, kg/m2
  std::optional<double> area_m2;
  std::optional<TitleReading> reading;    ///< of the columns' titles
  std::optional<StationReading> station;  ///< content of the headers of a network's files
  StationPlan station_plan;
  std::vector<int> levels;       ///< floors with accelerometers, ascending; empty: all
  std::string wanted_per_level;  ///< the answer to per-level as typed, for earlier defaults
  bool wants_points = false;     ///< a channel's place is a point in plan
  std::string per_level;  ///< letters of the channels on each of them; empty: one on every frame
};

/// A question without a valid answer.
struct OpenQuestion {
  std::string option;  ///< "stories"; "channel": the place stands in `ask`
  std::string ask;
  std::string initial;         ///< meaning of an empty answer; empty if an answer is required
  std::string problem;         ///< why the answer is invalid; empty without an answer
  std::optional<Place> place;  ///< set if the question is about the column of this place
  std::string answer = {};     ///< for a channel: its invalid answer
  std::string column = {};     ///< for a station: the column whose place is asked
};

/// An answer in the summary.
struct UnderstoodAnswer {
  std::string option, title, text;
};

struct InitReading {
  BuildingDraft draft;
  std::vector<OpenQuestion> open;
  std::vector<UnderstoodAnswer> understood;
};

}  // namespace framewatch::daemon
