// SPDX-License-Identifier: MIT
// Tests the page and diagnosis.json of diagnoses made by hand: their numbers agree, and no
// diagnosis breaks them.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "daemon/tools/diagnosis/evidence_section.h"
#include "daemon/tools/diagnosis/next_measurement.h"
#include "daemon/tools/diagnosis/search_section.h"
#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/trials/trial.h"
#include "estimator/diagnose/verdict/evidence.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::daemon {
namespace diagnose_report_test {

using estimator::EffectKind;
using estimator::FoundEffect;
using estimator::Verdict;

constexpr double kCubic = 2e10;  // N/m^3

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t out = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++out;
  return out;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A building with a cubic spring, its two records, and a diagnosis of them.
struct Case {
  test::EffectTwins twins = test::cubic_spring(0, kCubic);
  test::Recorded recorded{test::records_with({twins.simulated}, {1, 2})};
  Config config;
  std::vector<DiagnoseRecord> records{{"monday.csv", "a", {}}, {"tuesday.csv", "b", {}}};
  estimator::Diagnosis diagnosis;
  std::size_t holdout_from = 1;

  Case() {
    estimator::Diagnosis& d = diagnosis;
    d.linear = test::true_model(recorded.small, recorded.plant);
    d.model = test::with_effects(d.linear, {twins.modelled});
    d.before_model = d.linear;
    d.after_model = d.model;
    d.ratio_before = 30;
    d.ratio_after = 1;
    estimator::WhereEntry where;
    where.place = test::in_frame(0);
    where.ratio = 1;
    d.where = d.map = {where};
    d.before = gaps_of(recorded.fitter, d.before_model);
    d.after = gaps_of(recorded.fitter, d.after_model);
  }

  FoundEffect& add(EffectKind kind, int index) {
    FoundEffect found;
    found.chosen = trial(kind, 0);
    found.chosen.fraction = 0.99;
    found.confidence = 0.987;
    found.index = index;
    found.before = mean_gap(diagnosis.before, 1);
    found.after = mean_gap(diagnosis.after, 1);
    diagnosis.effects.push_back(found);
    return diagnosis.effects.back();
  }

  /// behind: log-likelihood behind the effect.
  estimator::Trial trial(EffectKind kind, double behind) const {
    estimator::Trial out;
    out.kind = kind;
    out.place = test::in_frame(0);
    out.cost = 1000 + behind;
    out.misfit = {500 + behind / 2, 500 + behind / 2};
    out.model = diagnosis.linear;
    return out;
  }

  DiagnoseOutput output() {
    diagnosis.evidence = evidence_of(recorded.plant, recorded.segments, holdout_from, diagnosis);
    return {config, recorded.plant, records, recorded.segments, holdout_from, diagnosis};
  }
};

/// Checks what every page must hold.
void expect_sound(const DiagnoseOutput& o) {
  const std::string page = diagnosis_report(o);
  EXPECT_TRUE(page.starts_with("<!doctype html>") || page.starts_with("<!DOCTYPE html>"));
  EXPECT_EQ(page, diagnosis_report(o)) << "the same bytes";
  EXPECT_FALSE(has(page, "<script"));
  EXPECT_FALSE(has(page, "http"));
  EXPECT_FALSE(has(page, "nan ") || has(page, ">nan") || has(page, ",nan"));
  EXPECT_FALSE(has(page, "inf "));
  EXPECT_EQ(count(page, "<svg class=\"plot\""),
            count(page, "role=\"img\" aria-label=\"") + count(page, "role=\"img\"><title>"));
  const nlohmann::json json = nlohmann::json::parse(diagnosis_json(o));
  EXPECT_TRUE(json.contains("evidence"));
  EXPECT_EQ(json["measure_next"], next_measurement(o));
}

TEST(DiagnosisReport, DrawsTheSearch) {
  Case c;
  c.diagnosis.verdict = Verdict::explained;
  FoundEffect& f = c.add(EffectKind::cubic_stiffness, 0);
  EXPECT_TRUE(has(search_section(c.output()), "linear 30; places 1; model 1."));
  f.alternatives = {c.trial(EffectKind::bouc_wen, 3000), c.trial(EffectKind::pinching, 9000)};
  f.alternatives.back().outcome = estimator::TrialOutcome::screened_out;  // no free run
  const std::string drawn = search_section(c.output());
  EXPECT_TRUE(has(drawn, "laws")) << drawn;
  EXPECT_EQ(count(drawn, "<circle"), 7U) << "a place, two laws, two models, two in the legend";
  EXPECT_TRUE(has(diagnosis_report(c.output()), drawn));
  c.diagnosis.map.clear();  // a channel's drift alone needs no search
  EXPECT_EQ(search_section(c.output()), "");
}

TEST(DiagnosisReport, SaysTheSameEverywhere) {
  Case c;
  c.diagnosis.verdict = Verdict::explained;
  FoundEffect& f = c.add(EffectKind::cubic_stiffness, 0);
  f.alternatives = {c.trial(EffectKind::bouc_wen, 300)};
  const DiagnoseOutput o = c.output();
  expect_sound(o);
  const std::string page = diagnosis_report(o), text = diagnosis_text(o);
  const nlohmann::json json = nlohmann::json::parse(diagnosis_json(o));
  const std::string certainty = confidence_words(o, c.diagnosis.effects[0]);
  EXPECT_EQ(certainty, "established (confidence 0.987)");
  EXPECT_EQ(json["effects"][0]["certainty"], certainty);
  EXPECT_EQ(json["effects"][0]["confidence"], 0.987);
  for (const std::string& said : {certainty, gap_sentence(o)}) {
    EXPECT_TRUE(has(page, said)) << said;
    EXPECT_TRUE(has(text, said)) << said;
  }
  EXPECT_EQ(gap_percent(json["gap"]["after"]["holdout"]["overall"]),
            gap_percent(mean_gap(c.diagnosis.after, 1)));
  EXPECT_FALSE(has(page, "with it the held-out gap falls")) << "one effect: the gap is said once";
  EXPECT_EQ(next_measurement(o), "") << "nothing rivals";

  ASSERT_EQ(c.diagnosis.evidence.forces.size(), 1U);
  const estimator::PlaceForce& force = c.diagnosis.evidence.forces[0];
  EXPECT_EQ(force.record, 1U);
  const std::string sentence = force_sentence(o, force);
  EXPECT_TRUE(has(page, sentence)) << sentence;
  EXPECT_TRUE(has(text, sentence)) << sentence;
  const nlohmann::json& told = json["evidence"]["forces"][0];
  EXPECT_EQ(told["peak_force_n"]["measured"], force.measured_n);
  EXPECT_EQ(told["difference_share"]["with_effects"], force.with_effects_off);
  EXPECT_LT(force.with_effects_off, force.linear_off / 3);
  EXPECT_TRUE(has(page, "restoring force, kN"));
  EXPECT_TRUE(has(page, "deformation, mm"));
  EXPECT_TRUE(has(page, "bouc_wen"));
  const double left =
      misfit_ratio(c.recorded.plant, c.recorded.segments, c.trial(EffectKind::bouc_wen, 300));
  EXPECT_NEAR(left, 1300 / c.recorded.fitter.expected(c.diagnosis.linear), 1e-12);
  EXPECT_TRUE(has(page, fmt::format("<td>{:.3g}</td><td>300</td>", left)));
  EXPECT_EQ(json["effects"][0]["alternatives"][0]["misfit_ratio"], left);
}

TEST(DiagnosisReport, OfNothingMissingHasNoForceAndNoAdvice) {
  Case c;
  c.diagnosis.verdict = Verdict::adequate;
  c.diagnosis.where.clear();
  const DiagnoseOutput o = c.output();
  expect_sound(o);
  EXPECT_TRUE(c.diagnosis.evidence.forces.empty());
  EXPECT_FALSE(has(diagnosis_report(o), "Measure next"));
  EXPECT_FALSE(has(diagnosis_report(o), "Force and deformation"));
}

TEST(DiagnosisReport, ShowsTheLikeliestElementIfNothingIsNamed) {
  Case c;
  c.diagnosis.after = c.diagnosis.before;
  c.diagnosis.after_model = c.diagnosis.model = c.diagnosis.before_model;
  const DiagnoseOutput o = c.output();
  expect_sound(o);
  ASSERT_EQ(c.diagnosis.evidence.forces.size(), 1U);
  EXPECT_FALSE(c.diagnosis.evidence.forces[0].has_law);
  const std::string page = diagnosis_report(o);
  EXPECT_TRUE(has(page, "by the linear model"));
  EXPECT_FALSE(has(page, "with the effect"));
  EXPECT_TRUE(has(page, "Measure next"));
  EXPECT_TRUE(has(page, "still follows a pattern")) << residual_sentence(o);
}

TEST(DiagnosisReport, TellsTheStepsOfManyEffects) {
  Case c;
  c.diagnosis.verdict = Verdict::partly_explained;
  c.add(EffectKind::cubic_stiffness, 0).approximate = true;
  FoundEffect& ramp = c.add(EffectKind::bias_drift, -1);
  ramp.chosen.place = test::at_channel(1);
  ramp.ramp_mps3 = {0, 0.01};
  ramp.ramp_from_s = {0, 3};
  ramp.drift_rms_mps2 = {0, 0};
  const DiagnoseOutput o = c.output();
  expect_sound(o);
  const std::string page = diagnosis_report(o);
  EXPECT_EQ(count(page, "with it the held-out gap falls"), 2U);
  EXPECT_EQ(c.diagnosis.evidence.forces.size(), 1U) << "a sensor has no force";
  EXPECT_TRUE(has(page, "with the effects"));
}

TEST(DiagnosisReport, SurvivesRunsThatDiverge) {
  Case c;
  c.diagnosis.verdict = Verdict::partly_explained;
  c.add(EffectKind::cubic_stiffness, 0);
  c.diagnosis.after.clear();
  expect_sound(c.output());
  c.diagnosis.before.clear();
  expect_sound(c.output());
  EXPECT_TRUE(c.diagnosis.evidence.forces.empty());
}

TEST(DiagnosisReport, WithoutHeldOutRecordsUsesAll) {
  Case c;
  c.holdout_from = 2;
  c.diagnosis.verdict = Verdict::explained;
  c.add(EffectKind::cubic_stiffness, 0);
  const DiagnoseOutput o = c.output();
  expect_sound(o);
  EXPECT_FALSE(c.diagnosis.evidence.floors.empty());
}

TEST(ConfidenceWords, SayWhatIsMissing) {
  Case c;
  FoundEffect& f = c.add(EffectKind::cubic_stiffness, 0);
  const DiagnoseOutput o = c.output();
  f.confidence = 0.5;
  f.alternatives = {c.trial(EffectKind::quadratic_stiffness, 4), c.trial(EffectKind::bouc_wen, 9)};
  f.like = {EffectKind::quadratic_stiffness};
  EXPECT_EQ(confidence_words(o, f), "leading (confidence 0.5): quadratic stiffness fits as well");
  f.like.clear();
  f.confidence = 0.59;
  EXPECT_EQ(confidence_words(o, f),
            "leading (confidence 0.59): quadratic stiffness at story 1, frame y1 is 4 in "
            "log-likelihood behind");
  f.approximate = true;
  EXPECT_EQ(confidence_words(o, f),
            "leading (confidence 0.59): more than noise is left, so its form may be another");
  f.nearest = true;
  EXPECT_EQ(confidence_words(o, f),
            "leading (confidence 0.59): it is the nearest law, and leaves more than it should");
}

}  // namespace diagnose_report_test
}  // namespace framewatch::daemon
