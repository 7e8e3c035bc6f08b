// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/base/svg_plot.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimates/session_estimates.h"
#include "daemon/tools/report/frame_loops.h"
#include "daemon/tools/report/record_modes.h"
#include "daemon/tools/report/report_about.h"
#include "daemon/tools/report/report_units.h"
#include "daemon/tools/report/session_changes.h"
#include "daemon/tools/report/session_file.h"
#include "daemon/tools/report/session_floors.h"
#include "daemon/tools/report/session_motion.h"
#include "daemon/tools/report/transfer_function.h"

namespace framewatch::daemon {

/// A stage of the session that the report compares with others: forced or free vibration, before or
/// after a change of the building, never across one.
struct ReportStage {
  StageKind kind;
  std::string name;  ///< "forced vibration, after the change"; "all of it" without raw samples
  std::int64_t from_us, to_us;  ///< sensor time
  bool after = false;           ///< lies after a change
  WindowRange whole;            ///< every window that lies wholly in the stage
  WindowRange boxes;            ///< the last boxplot_windows of them (free vibration: the first)
};

/// Drift and force in the strongest motion of a stage.
struct StageLoops {
  std::size_t stage;  ///< of SessionReport::compared
  FrameLoops loops;
};

/// The modes in a forced stage.
struct StageModes {
  std::size_t stage;  ///< of SessionReport::compared
  RecordModes modes;
};

struct ReportFile {
  std::string use, path, sha256;
};

/// Everything a session's report shows. The same input gives the same bytes.
///
/// Fill in the input (texts, estimates, session, config, motion), then call evaluate().
struct SessionReport {
  std::string title, test, operator_name, notes;  ///< by the operator; may be empty
  SessionEstimates estimates;
  std::optional<SessionFile> session;  ///< of `framewatch record`
  std::optional<Config> config;
  std::optional<SessionMotion> motion;
  std::vector<Stage> stages;                       ///< empty without motion
  std::vector<ElementChange> changes, recoveries;  ///< recoveries are not among the changes
  std::vector<JudgedElement> judged;  ///< stiffnesses in which a change would have shown
  std::vector<ReportStage> compared;  ///< at least one
  /// Table order, SI, NaN: unknown. reference_static: the design of the configuration, or the
  /// estimator's start values. reference_dynamic: of frames, by the ratio of natural frequencies.
  std::vector<double> reference_static, reference_dynamic;
  std::vector<std::string> no_reference_dynamic;  ///< why a value is missing; empty: it exists
  bool reference_from_drawings = false;
  std::vector<TransferFunction> transfer;        ///< of the longest forced stage before a change
  std::vector<TransferFunction> transfer_after;  ///< of the one after it; empty without a change
  std::vector<StageLoops> loops;
  std::vector<StageModes> modes;
  std::optional<DriftReport> drifts;    ///< with motion
  std::optional<SessionFloors> floors;  ///< with motion, for a building of groups
  std::vector<ReportFile> files;
  ReportAbout about;
  ReportUnits units;
  FrameLabels labels;  ///< what people call the frames; from config
};

/// Computes the fields that follow from estimates, config and motion.
void evaluate(SessionReport& report);

/// Returns the whole page.
std::string session_report_html(const SessionReport& report);

/// Returns one sentence for the building's owner: whether the building changed, and where.
std::string verdict_sentence(const SessionReport& report);

/// Says whether a tall building's record needs bending of the frames that the configuration leaves
/// out. Returns "" when there is nothing to say.
std::string bending_sentence(const SessionReport& report);

/// Returns every picture of the page, with stable names.
std::vector<Picture> session_pictures(const SessionReport& report);
std::vector<Picture> change_pictures(const SessionReport& report);     ///< of verdict_section()
std::vector<Picture> parameter_pictures(const SessionReport& report);  ///< of figure_10_section()

// Each section below is HTML, "" when it has nothing to show.
std::string verdict_section(const SessionReport& report);
std::string events_section(const SessionReport& report);
std::string figure_10_section(const SessionReport& report);
std::string stages_section(const SessionReport& report);
std::string histories_section(const SessionReport& report);
std::string transfer_section(const SessionReport& report);
std::string modes_section(const SessionReport& report);
std::string loops_section(const SessionReport& report);
std::string floors_section(const SessionReport& report);

/// Returns the seconds since the session's first window or sample.
double session_seconds(const SessionReport& report, std::int64_t time_us);
/// Returns the words for a parameter's place: "story 1, north wall".
std::string place_of(const SessionReport& report, std::size_t parameter);
/// Returns the words for a stiffness, "north wall (y2) of story 1", and the name of any other
/// parameter.
std::string element_of(const SessionReport& report, std::size_t parameter);

}  // namespace framewatch::daemon
