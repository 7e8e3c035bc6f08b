// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/diagnosis/diagnose_records.h"
#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::daemon {

/// Everything that the outputs of a diagnosis are made from.
struct DiagnoseOutput {
  const Config& config;
  const estimator::Plant& plant;
  const std::vector<DiagnoseRecord>& records;  ///< training records first
  const std::vector<estimator::RecordSegment>& segments;
  std::size_t holdout_from;  ///< index of the first held-out record
  const estimator::Diagnosis& diagnosis;
};

/// Returns the content of diagnosis.json, schema framewatch.diagnosis/1 (docs/formats.md).
std::string diagnosis_json(const DiagnoseOutput& output);
/// Returns the content of report.html, a self-contained page.
std::string diagnosis_report(const DiagnoseOutput& output);

// The functions below describe a diagnosis for the people who look after the building. All but
// kind_section() return text, not HTML.

/// Returns one sentence: what the model lacks, and where.
std::string verdict_sentence(const DiagnoseOutput& output);

/// Returns the gap in one figure: free-run NRMSE of the held-out records before and after, next to
/// its floor.
std::string gap_sentence(const DiagnoseOutput& output);

/// Returns the input of every free run: "motion of the base", "force", or both.
std::string driver_words(const DiagnoseOutput& output);

/// Returns the quantity that every overall gap is a share of.
std::string denominator_words(const DiagnoseOutput& output);
const char* gap_unit(const DiagnoseOutput& output);  ///< unit of that quantity

/// Returns "something like bouc wen at story 1, frame y1 (gradual yielding)".
std::string effect_words(const DiagnoseOutput& output, const estimator::FoundEffect& effect);

/// Returns a fall of the gap as a share, 0..1, of the held-out gap before.
double share_of_gap(const DiagnoseOutput& output, double fall);

/// Returns the damping ratios that modes have in addition to the dashpots; "" without any.
std::string damping_sentence(const DiagnoseOutput& output);

/// Describes the best law that is not established; "" without one.
std::string leading_sentence(const DiagnoseOutput& output);

/// Returns how certain the name of an effect is: grade, confidence, and what the confidence lacks.
std::string confidence_words(const DiagnoseOutput& output, const estimator::FoundEffect& effect);

/// Returns the change of the held-out gap by one of several effects; "" if there is only one, whose
/// change gap_sentence() gives.
std::string step_words(const DiagnoseOutput& output, const estimator::FoundEffect& effect);

/// Returns one sentence: the kind of force that the likeliest element needs, whatever its law. ""
/// if no element was examined or a linear one is enough.
std::string kind_sentence(const DiagnoseOutput& output);

/// The kinds of law whose share of a force the report gives.
inline constexpr std::array kReportedKinds = {
    estimator::LawKind::elastic, estimator::LawKind::impact, estimator::LawKind::dissipative,
    estimator::LawKind::hysteretic, estimator::LawKind::time_varying};

/// Returns HTML of kind_sentence() with pictures: the force beyond a linear element over
/// deformation, and its means over deformation and over rate. "" if kind_sentence() is.
std::string kind_section(const DiagnoseOutput& output);

/// A channel whose noise exceeds the configured one, densities in m/s^2/sqrt(Hz).
struct NoiseBeyond {
  std::size_t axis = 0;
  double configured = 0;
  double read = 0;  ///< by quiet_noise_variance() of the quietest record
};

/// Returns the accelerations that read more than twice the configured noise at frequencies without
/// motion of the building. A diagnosis may fail to explain that noise.
std::vector<NoiseBeyond> noise_beyond_configured(
    const estimator::Plant& plant, const std::vector<estimator::RecordSegment>& segments);

/// Describes noise_beyond_configured() and what to do; "" without such channels, or if nothing is
/// left to explain.
std::string noise_sentence(const DiagnoseOutput& output);

/// Returns a sentence on Diagnosis::not_done; "" if the diagnosis is whole.
std::string limit_sentence(const DiagnoseOutput& output);

/// Returns the text that the command prints: all of these.
std::string diagnosis_text(const DiagnoseOutput& output);

std::string gap_percent(double share);  ///< "12.34 %"

}  // namespace framewatch::daemon
