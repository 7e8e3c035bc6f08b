// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/diagnose_verdict.h"

#include <array>

#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/tools/diagnosis/evidence_section.h"
#include "daemon/tools/diagnosis/next_measurement.h"
#include "daemon/tools/simulation/simulation_truth.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "estimator/diagnose/verdict/evidence.h"
#include "estimator/diagnose/verdict/verdict.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

/// Returns [from, to], or null when unknown.
Json span(double from, double to) {
  return to > from ? Json{json_value(from), json_value(to)} : Json(nullptr);
}

/// Returns the gap, or its floor, of every channel and overall, averaged over the training or the
/// held-out segments.
Json gap_json(const DiagnoseOutput& o, const std::vector<estimator::Gap>& gaps, bool holdout,
              bool floor) {
  Json channels = Json::object();
  double overall = 0;
  int count = 0;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(o.plant.axis_count());
  for (std::size_t r = 0; r < gaps.size(); ++r) {
    if ((r >= o.holdout_from) != holdout) continue;
    overall += floor ? gaps[r].overall_floor : gaps[r].overall;
    sum += floor ? gaps[r].floor : gaps[r].axis;
    ++count;
  }
  if (count == 0) return {{"overall", nullptr}, {"channels", Json::object()}};
  for (Eigen::Index a = 0; a < sum.size(); ++a)
    if (!o.plant.is_input(a) || o.plant.prescribed)
      channels[o.plant.axes[static_cast<std::size_t>(a)].name] = json_value(sum[a] / count);
  return {{"overall", json_value(overall / count)}, {"channels", channels}};
}

Json both(const DiagnoseOutput& o, const std::vector<estimator::Gap>& gaps, bool floor) {
  return {{"train", gap_json(o, gaps, false, floor)}, {"holdout", gap_json(o, gaps, true, floor)}};
}

/// Returns the quantity that every overall gap is a share of.
Json denominator_json(const DiagnoseOutput& o) {
  Json rms = Json::array();
  for (const estimator::Gap& g : o.diagnosis.before) rms.push_back(json_value(g.measured_rms));
  return {{"of", denominator_words(o)}, {"unit", gap_unit(o)}, {"rms_of_records", rms}};
}

/// Returns name, place and parameters of an effect.
Json effect_json(const DiagnoseOutput& o, const estimator::FoundEffect& f) {
  const estimator::Effect effect = catalogue_effect(o.plant, o.segments, f, o.diagnosis.model);
  Json parameters = parameters_json(effect);
  std::size_t index = 0;
  for (auto& [key, value] : parameters.items()) {
    if (index < f.std_error.size() && f.std_error[index] > 0)
      value["std_error"] = json_value(f.std_error[index]);
    ++index;
  }
  return {{"effect", std::string(name_of(effect.kind))},
          {"location", location_json(effect.place, o.plant.structure, o.plant.axes)},
          {"parameters", parameters}};
}

/// Returns the kind of a place's law and the share that each kind explains; null if not examined.
Json kind_json(const estimator::WhereEntry& where) {
  if (!where.kind) return nullptr;
  Json share = Json::object();
  for (const estimator::LawKind kind : kReportedKinds)
    share[law_kind_word(kind)] = json_value(where.kind->share[static_cast<std::size_t>(kind)]);
  return {{"name", law_kind_word(where.kind->kind)}, {"explained_share", share}};
}

/// Words for estimator::TrialOutcome, in its order.
constexpr std::array kOutcomeWords = {"fitted", "screened_out", "diverged", "other_law"};

Json numbers(const Eigen::VectorXd& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(json_value(value));
  return out;
}

Json force_json(const DiagnoseOutput& o, const estimator::PlaceForce& f) {
  const auto if_known = [](bool known, double value) {
    return known ? json_value(value) : Json(nullptr);
  };
  const bool linear = f.linear.d_m.size() > 0, with = f.with_effects.d_m.size() > 0;
  return {{"location", location_json(f.place, o.plant.structure, o.plant.axes)},
          {"record", o.records[f.record].path},
          {"measured", f.measured},
          {"source", force_source(o, f)},
          {"band_hz", span(f.low_hz, f.high_hz)},
          {"peak_deformation_m", json_value(f.peak_d_m)},
          {"peak_force_n",
           {{"measured", if_known(f.measured, f.measured_n)},
            {"linear", if_known(linear, f.linear_n)},
            {"with_effects", if_known(with, f.with_effects_n)}}},
          {"difference_share",
           {{"linear", if_known(f.measured && linear, f.linear_off)},
            {"with_effects", if_known(f.measured && with, f.with_effects_off)}}},
          {"measured_rms_n", if_known(f.measured, f.measured_rms_n)},
          {"noise_rms_n", if_known(f.measured, f.noise_n)},
          {"share_by_model", if_known(f.measured, f.modelled_share)}};
}

/// Returns the evidence; `after` is null if the model with the effects diverges.
Json evidence_json(const DiagnoseOutput& o) {
  const estimator::Evidence& e = o.diagnosis.evidence;
  Json forces = Json::array(), floors = Json::array();
  for (const estimator::PlaceForce& f : e.forces) forces.push_back(force_json(o, f));
  for (const estimator::FloorGap& g : e.floors)
    floors.push_back({{"story", g.story},
                      {"before", json_value(g.before)},
                      {"after", json_value(g.after)},
                      {"noise_floor", json_value(g.floor)}});
  const auto or_null = [](const Eigen::VectorXd& values) {
    return values.size() > 0 ? numbers(values) : Json(nullptr);
  };
  const estimator::ResidualCorrelation& c = e.correlation;
  const bool after = c.after.size() > 0;
  return {{"forces", forces},
          {"gap_by_floor", floors},
          {"gap_by_frequency",
           {{"unit", std::string(gap_unit(o)) + "/sqrt(Hz)"},
            {"frequency_hz", numbers(e.spectrum.hz)},
            {"measured", numbers(e.spectrum.measured)},
            {"before", numbers(e.spectrum.before)},
            {"after", or_null(e.spectrum.after)},
            {"noise_floor", numbers(e.spectrum.noise)}}},
          {"residual_autocorrelation",
           {{"lag_s", numbers(c.lag_s)},
            {"before", numbers(c.before)},
            {"after", or_null(c.after)},
            {"white_noise_band", json_value(c.white_band)},
            {"lags_outside_before", c.before_outside},
            {"lags_outside_after", after ? Json(c.after_outside) : Json(nullptr)},
            {"rms_over_noise_before", json_value(c.before_level)},
            {"rms_over_noise_after", after ? json_value(c.after_level) : Json(nullptr)}}}};
}

Json trial_json(const DiagnoseOutput& o, const estimator::Trial& t) {
  Json out{{"effect", std::string(name_of(t.kind))},
           {"location", location_json(t.place, o.plant.structure, o.plant.axes)},
           {"explained_share", json_value(t.fraction)},
           {"misfit", json_value(t.cost)},
           {"misfit_ratio", json_value(misfit_ratio(o.plant, o.segments, t))},
           {"fate", kOutcomeWords[static_cast<std::size_t>(t.outcome)]}};
  if (t.second)
    out["together_with"] = {
        {"effect", std::string(name_of(t.second->first))},
        {"location", location_json(t.second->second, o.plant.structure, o.plant.axes)}};
  return out;
}

/// Returns the identified parameters next to those of the design.
Json parameters_of(const DiagnoseOutput& o) {
  const estimator::Plant& plant = o.plant;
  const estimator::Model& model = o.diagnosis.model;
  Json out = Json::object();
  const auto add = [&](const estimator::Parameter& p, double value, double design) {
    out[p.name] = {{"value", json_value(value)}, {"unit", p.unit}, {"design", json_value(design)}};
  };
  if (plant.groups.empty()) {
    for (int p = 0; p < plant.table.size(); ++p)
      if (!plant.stiff_floors || plant.table[p].panel < 0)
        add(plant.table[p], model.theta[p], plant.design[p]);
    return out;
  }
  const estimator::StoryGroups groups =
      story_groups(plant.structure, plant.axes, {{}, plant.bending.any()});
  const estimator::ParameterTable table(plant.structure, groups, plant.bending);
  estimator::BendingStiffness bending = plant.bending;
  for (const estimator::ModelEffect& e : model.effects) {
    const std::size_t along = e.place.direction == estimator::Direction::x ? 0 : 1;
    if (e.form == estimator::LawForm::bending && plant.bending[along] > 0)
      bending.base_nmprad[along] = 1 / e.parameters[0].plain();
  }
  const Eigen::VectorXd value = group_parameters(plant.structure, table, {model.theta, bending});
  const Eigen::VectorXd design =
      group_parameters(plant.structure, table, {plant.design, plant.bending});
  for (int p = 0; p < table.size(); ++p) add(table[p], value[p], design[p]);
  return out;
}

/// Returns the numbers of the search that are not its defaults.
Json changed_settings(const estimator::SearchSettings& settings) {
  Json out = Json::object();
  for (const estimator::SearchSetting& s : estimator::search_settings())
    if (s.of(settings) != s.of({})) out[s.name] = s.of(settings);
  return out;
}

Json provenance_of(const DiagnoseOutput& o) {
  Json files = Json::array();
  for (std::size_t r = 0; r < o.records.size(); ++r)
    files.push_back({{"file", o.records[r].path},
                     {"sha256", o.records[r].sha256},
                     {"use", r < o.holdout_from ? "train" : "holdout"}});
  return {{"config", o.config.path}, {"config_sha256", o.config.sha256},
          {"records", files},        {"version", FRAMEWATCH_VERSION},
          {"command", "diagnose"},   {"settings", changed_settings(o.diagnosis.settings)}};
}

}  // namespace

std::string diagnosis_json(const DiagnoseOutput& o) {
  const estimator::Diagnosis& d = o.diagnosis;
  Json out{{"schema", "framewatch.diagnosis/1"}, {"verdict", verdict_word(d.verdict)}};
  if (!d.reason.empty()) out["reason"] = d.reason;
  out["search"] = {{"complete", d.not_done.empty()}, {"not_done", d.not_done}};
  out["gap"] = {{"before", both(o, d.before, false)},
                {"after", both(o, d.after, false)},
                {"noise_floor", both(o, d.before, true)},
                {"denominator", denominator_json(o)},
                {"after_is_of_a_model_fitted_to", d.after_of_all ? "all records" : "train"},
                {"misfit_ratio_before", json_value(d.ratio_before)},
                {"misfit_ratio_after", json_value(d.ratio_after)},
                {"noise_corner_hz", json_value(d.noise_corner_hz)}};
  out["noise_beyond_configured"] = Json::array();
  for (const NoiseBeyond& n : noise_beyond_configured(o.plant, o.segments))
    out["noise_beyond_configured"].push_back({{"channel", o.plant.axes[n.axis].name},
                                              {"configured_mps2_per_rthz", n.configured},
                                              {"read_mps2_per_rthz", n.read}});
  out["modal_damping"] = Json::array();
  for (const estimator::Effect& e : modal_damping_effects(d.model))
    out["modal_damping"].push_back(
        {{"mode", e.place.mode}, {"damping_ratio", json_value(e.value("damping_ratio"))}});
  out["effects"] = Json::array();
  for (const estimator::FoundEffect& f : d.effects) {
    Json one = effect_json(o, f);
    one.update(Json{{"holdout_nrmse_before", json_value(f.before)},
                    {"holdout_nrmse_after", json_value(f.after)},
                    {"explained_share", json_value(f.chosen.fraction)},
                    {"share_of_gap", json_value(share_of_gap(o, f.before - f.after))},
                    {"grade", grade_word(grade_of(f))},
                    {"confidence", json_value(f.confidence)},
                    {"certainty", confidence_words(o, f)},
                    {"approximate", f.approximate},
                    {"alternatives", Json::array()},
                    {"indistinguishable_from", Json::array()}});
    for (const estimator::Trial& t : f.alternatives)
      one["alternatives"].push_back(trial_json(o, t));
    for (const estimator::EffectKind kind : f.like)
      one["indistinguishable_from"].push_back(std::string(name_of(kind)));
    out["effects"].push_back(one);
  }
  out["known_effects"] = Json::array();
  for (const estimator::FoundEffect& f : d.known) out["known_effects"].push_back(effect_json(o, f));
  out["candidates_rejected"] = Json::array();
  for (const estimator::Trial& t : d.rejected)
    out["candidates_rejected"].push_back(trial_json(o, t));
  out["leading"] = Json::array();
  for (const estimator::LeadingLaw& l : d.leading) {
    Json one = trial_json(o, l.trial);
    one.update(Json{{"grade", "leading"},
                    {"holdout_nrmse_before", json_value(l.before)},
                    {"holdout_nrmse_after", json_value(l.after)},
                    {"share_of_gap", json_value(share_of_gap(o, l.before - l.after))}});
    out["leading"].push_back(one);
  }
  out["where"] = Json::array();
  for (const estimator::WhereEntry& w : d.where)
    out["where"].push_back(
        {{"location", location_json(w.place, o.plant.structure, o.plant.axes)},
         {"misfit_ratio_if_free", json_value(w.ratio)},
         {"record", o.records[w.record].path},
         {"time_s", span(w.from_s, w.to_s)},
         {"band_hz", span(w.low_hz, w.high_hz)},
         {"peak", w.peak > 0 ? json_value(w.peak) : Json(nullptr)},
         {"peak_unit", w.place.kind == estimator::PlaceKind::channel ? "m/s^2" : "N"},
         {"kind", kind_json(w)}});
  out["measure_next"] = next_measurement(o);
  out["evidence"] = evidence_json(o);
  out["parameters"] = parameters_of(o);
  out["provenance"] = provenance_of(o);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
