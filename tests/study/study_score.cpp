// SPDX-License-Identifier: MIT
#include "tests/study/study_score.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <iterator>

#include <nlohmann/json.hpp>

#include "estimator/diagnose/propose/law_kind.h"

namespace framewatch::study {
namespace {

using Json = nlohmann::json;
constexpr double kSure = 0.9, kDoubtful = 0.5;  ///< confidence

Json read_json(const std::string& path) {
  std::ifstream in(path);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return Json::parse(text, nullptr, false);
}

std::string text_of(const Json& json, const char* key) {
  return json.is_object() && json.contains(key) && json[key].is_string() ? json[key] : "";
}

/// Returns the family of a law: laws that one curve describes equally well.
std::string family(const std::string& name) {
  if (name == "bouc_wen") return "bilinear_hysteresis";
  return name;
}

/// Returns true if the diagnosed place is the true one, in the fields that both have.
bool same_place(const Json& truth, const Json& found) {
  const std::string kind = text_of(truth, "kind");
  const bool channel = kind == "channel" || kind == "base";
  if (channel) {
    const std::string a = text_of(truth, "channel"), b = text_of(truth, "with_channel");
    const std::string c = text_of(found, "channel"), d = text_of(found, "with_channel");
    return a == c || (!b.empty() && a == d && b == c);
  }
  if (text_of(found, "kind") != kind) return false;
  const auto keys = kind == "building"       ? std::vector<const char*>{"direction"}
                    : kind == "whole_frame"  ? std::vector<const char*>{"frame"}
                    : kind == "panel"        ? std::vector<const char*>{"story", "panel"}
                    : kind == "floor"        ? std::vector<const char*>{"story"}
                    : truth.contains("node") ? std::vector<const char*>{"story", "node"}
                                             : std::vector<const char*>{"story", "frame"};
  return std::all_of(keys.begin(), keys.end(), [&](const char* key) {
    return truth.contains(key) && found.contains(key) && truth[key] == found[key];
  });
}

std::vector<std::string> accepted_names(const Json& truth) {
  if (truth.contains("accepted")) return truth["accepted"].get<std::vector<std::string>>();
  return {text_of(truth, "effect")};
}

bool is_named(const Json& truth, const std::string& name, bool exactly) {
  for (const std::string& accepted : accepted_names(truth))
    if (exactly ? accepted == name : family(accepted) == family(name)) return true;
  return false;
}

std::optional<double> number(const Json& json, std::initializer_list<const char*> path) {
  const Json* at = &json;
  for (const char* key : path) {
    if (!at->is_object() || !at->contains(key)) return std::nullopt;
    at = &(*at)[key];
  }
  return at->is_number() ? std::optional<double>(at->get<double>()) : std::nullopt;
}

std::optional<double> first_of(std::initializer_list<std::optional<double>> candidates) {
  for (const auto& candidate : candidates)
    if (candidate) return candidate;
  return std::nullopt;
}

/// Returns true if the true name is among those that the diagnosis could not distinguish.
bool among_indistinguishable(const Json& truth, const Json& effect) {
  if (!effect.contains("indistinguishable_from")) return false;
  for (const Json& other : effect["indistinguishable_from"]) {
    const std::string name =
        other.is_string() ? other.get<std::string>() : text_of(other, "effect");
    const bool place = !other.is_object() || !other.contains("location") ||
                       same_place(truth["location"], other["location"]);
    if (place && is_named(truth, name, false)) return true;
  }
  return false;
}

void compare_parameters(const Json& truth, const Json& found, std::vector<double>& errors) {
  if (!truth.contains("parameters") || !found.contains("parameters")) return;
  for (const auto& [key, value] : truth["parameters"].items()) {
    const auto size = number(value, {"value"});
    const auto got = first_of({number(found, {"parameters", key.c_str(), "value"}),
                               number(found, {"parameters", key.c_str()})});
    const bool shape = key == "exponent" || key == "beta" || key == "v0_mps" || key == "seed" ||
                       key == "phase_rad" || key == "side" || key.starts_with("slip");
    if (size && got && *size != 0 && !shape) errors.push_back(std::abs(*got / *size - 1));
  }
}

/// Returns true if a law is of the true kind, or of the kind of the hidden law.
bool same_kind(const Json& truth, const std::string& name) {
  using estimator::LawKind;
  const auto law = estimator::find_effect(name);
  const auto hidden = estimator::find_effect(text_of(truth, "effect"));
  if (!law) return false;
  for (const LawKind kind : {LawKind::elastic, LawKind::impact, LawKind::dissipative,
                             LawKind::hysteretic, LawKind::time_varying}) {
    const bool there = hidden ? is_of_kind(*hidden, kind)
                              : text_of(truth, "kind") == estimator::law_kind_word(kind);
    if (there && is_of_kind(*law, kind)) return true;
  }
  return false;
}

bool is_near(const Json& truths, const Json& found) {
  return std::any_of(truths.begin(), truths.end(), [&](const Json& truth) {
    return same_place(truth["location"], found["location"]) &&
           same_kind(truth, text_of(found, "effect"));
  });
}

void compare(const Json& truths, const Json& found, Outcome& out) {
  std::vector<bool> explained(found.size(), false);
  for (const Json& truth : truths) {
    bool place = false, right = false, exact = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::string name = text_of(found[i], "effect");
      const bool here = same_place(truth["location"], found[i]["location"]);
      const bool named = here && is_named(truth, name, false);
      const bool among = !named && among_indistinguishable(truth, found[i]);
      place = place || here || among;
      if (named || among) {
        explained[i] = true;
        right = true;
        out.told_apart = out.told_apart && named;
      }
      if (named && is_named(truth, name, true)) {
        exact = true;
        compare_parameters(truth, found[i], out.parameter_errors);
      }
    }
    out.places_right += place;
    out.right += right;
    out.exact += exact;
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    out.of_the_kind = out.of_the_kind && is_near(truths, found[i]);
    out.in_doubt = out.in_doubt && found[i].value("confidence", 1.0) <= kDoubtful;
    if (explained[i]) continue;
    out.extra = true;
    out.confidently_wrong = out.confidently_wrong || found[i].value("confidence", 1.0) > kSure;
  }
}

/// If nothing was named, the likeliest place counts as the claimed one.
void place_unnamed(const Json& truths, const Json& where, Outcome& out) {
  if (where.empty()) return;
  for (const Json& truth : truths)
    out.places_right += same_place(truth["location"], where.front()["location"]);
}

}  // namespace

std::optional<double> Outcome::removed() const {
  if (!gap_before || !gap_after || !noise_floor || *gap_before <= *noise_floor) return std::nullopt;
  return 1 - std::max(*gap_after - *noise_floor, 0.0) / (*gap_before - *noise_floor);
}

std::optional<Outcome> score(const std::string& directory, const std::string& folder) {
  const Json truth = read_json(directory + "/truth.json");
  if (truth.is_discarded() || !truth.contains("effects")) return std::nullopt;
  Outcome out;
  out.directory = directory;
  const Json study = truth.value("study", Json::object());
  out.group = folder == "out" ? text_of(study, "group") : folder;
  out.building = text_of(study, "building");
  out.hidden = text_of(study, "name");
  out.noise_ratio = study.value("noise_ratio", 0.0);
  out.truths = static_cast<int>(truth["effects"].size());
  const Json diagnosis = read_json(directory + "/" + folder + "/diagnosis.json");
  if (diagnosis.is_discarded()) {
    out.verdict = "refused";
    return out;
  }
  out.verdict = text_of(diagnosis, "verdict");
  const Json found = diagnosis.value("effects", Json::array());
  for (const Json& effect : found) out.named.push_back(text_of(effect, "effect"));
  compare(truth["effects"], found, out);
  if (found.empty()) place_unnamed(truth["effects"], diagnosis.value("where", Json::array()), out);
  out.gap_before = first_of({number(diagnosis, {"gap", "before", "holdout", "overall"}),
                             number(diagnosis, {"gap", "holdout", "before", "overall"})});
  out.gap_after = first_of({number(diagnosis, {"gap", "after", "holdout", "overall"}),
                            number(diagnosis, {"gap", "holdout", "after", "overall"})});
  out.noise_floor = first_of({number(diagnosis, {"gap", "noise_floor", "holdout", "overall"}),
                              number(diagnosis, {"gap", "holdout", "noise_floor", "overall"}),
                              number(diagnosis, {"gap", "noise_floor", "holdout"}),
                              number(diagnosis, {"gap", "noise_floor", "overall"}),
                              number(diagnosis, {"gap", "noise_floor"})});
  return out;
}

}  // namespace framewatch::study
