// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "tests/study/hidden.h"

namespace framewatch::study {
namespace {

using enum estimator::EffectKind;

estimator::EffectPlace random_place(estimator::EffectKind kind, const StudyBuilding& b,
                                    estimator::Random& random) {
  std::vector<estimator::EffectPlace> places = effect_places(kind, b.truth, b.axes);
  if (kind == one_sided_gap || kind == two_sided_gap)  // keeps the cases of earlier seeds
    std::erase_if(places, [](const estimator::EffectPlace& p) {
      return p.kind == estimator::PlaceKind::node_pair;
    });
  if (kind == swapped)  // base channels are rarely confused with those above
    std::erase_if(places, [&](const estimator::EffectPlace& p) {
      return (b.axes[static_cast<std::size_t>(p.channel)].story == 0) !=
             (b.axes[static_cast<std::size_t>(p.with_channel)].story == 0);
    });
  return places[static_cast<std::size_t>(random.uniform() * static_cast<double>(places.size()))];
}

int element_of(const estimator::EffectPlace& p, const estimator::ParameterTable& table) {
  return p.kind == estimator::PlaceKind::panel ? table.panel_stiffness(p.story, p.panel)
                                               : table.frame_stiffness(p.story, p.frame);
}

/// Scales of an element's effect.
struct ElementScale {
  double k, d, v;
};

/// Returns the largest deformation of all frames that amplitude_dependence acts on.
ElementScale frames_scale(const StudyBuilding& b, const Peaks& peaks,
                          const estimator::EffectPlace& p) {
  ElementScale out{1, 0, 0};
  for (int story = 1; story <= b.truth.stories; ++story)
    for (int f = 0; f < b.truth.frames(); ++f) {
      const bool own = p.kind == estimator::PlaceKind::whole_frame
                           ? f == p.frame
                           : b.truth.direction(f) == p.direction;
      const int i = b.table().frame_stiffness(story, f);
      out.d = std::max(out.d, own ? peaks.deformation[i] : 0);
      out.v = std::max(out.v, own ? peaks.rate[i] : 0);
    }
  return out;
}

double largest_size(estimator::EffectKind kind, bool softening) {
  switch (kind) {
    case cubic_stiffness:
      return softening ? 0.25 : 2;
    case quadratic_stiffness:
      return softening ? 0.4 : 2;
    case bilinear_hysteresis:
    case bouc_wen:
    case pinching:
      return 0.9;
    case coulomb_friction:
      return 0.5;
    case quadratic_damping:
      return 1;
    case one_sided_gap:
    case two_sided_gap:
      return 6;
    case stiffness_drop:
    case stiffness_drift:
    case amplitude_dependence:
      return 0.7;
    case tuned_mass_damper:
      return 0.2;
    case unmeasured_force:
      return 1;
    case gain_error:
      return 0.6;
    case clipping:
      return 0.9;
    case floor_flexibility:
      return 40;
    case misalignment:
      return 60;
    case time_shift:
      return 0.04;
    default:
      return 2;
  }
}

/// Returns the values at an element, in the order of the catalog, for size s. u: uniform draws.
std::vector<double> element_values(estimator::EffectKind kind, const ElementScale& e, double s,
                                   double sign, const double* u, double seconds) {
  switch (kind) {
    case cubic_stiffness:
      return {sign * s * e.k / (e.d * e.d)};
    case quadratic_stiffness:
      return {sign * s * e.k / e.d};
    case bilinear_hysteresis:
      return {s * e.k, (0.15 + 0.35 * u[0]) * e.d};
    case bouc_wen:
      return {s * e.k, (0.15 + 0.35 * u[0]) * e.d, u[1] < 0.5 ? 1.0 : 2.0, 0.5 + 0.3 * u[2]};
    case pinching:
      return {s * e.k,          (0.15 + 0.35 * u[0]) * e.d, 2,
              0.5 + 0.3 * u[2], 0.6 + 0.3 * u[1],           0.2 + 0.2 * u[3]};
    case coulomb_friction:
      return {s * e.k * e.d, (0.01 + 0.03 * u[0]) * e.v};
    case quadratic_damping:
      return {s * e.k * e.d / (e.v * e.v)};
    case one_sided_gap:
      return {s * e.k, (0.25 + 0.35 * u[0]) * e.d, u[1] < 0.5 ? -1.0 : 1.0};
    case two_sided_gap:
      return {s * e.k, (0.25 + 0.35 * u[0]) * e.d};
    case amplitude_dependence:
      return {s, e.d, 2, 0.5 * s * u[0] * e.d / (e.v * e.v)};
    case stiffness_drop:
      return {-s * e.k, std::round((0.3 + 0.3 * u[0]) * seconds * 100) / 100};
    case stiffness_drift:
      return {-s * e.k, 0.2 * seconds * u[0], (0.4 + 0.3 * u[1]) * seconds};
    default:
      return {};
  }
}

std::vector<double> node_values(estimator::EffectKind kind, const StudyBuilding& b,
                                const Peaks& peaks, const estimator::EffectPlace& p, double s,
                                const double* u) {
  const double k = b.theta[b.table().frame_stiffness(std::max(p.story, 1), std::max(p.frame, 0))];
  const double w1 = 2 * M_PI * peaks.first_mode_hz;
  const double mass = b.truth.frame_mass(std::max(p.story, 1), std::max(p.frame, 0));
  const double hz =
      peaks.first_mode_hz *
      std::pow(std::min(peaks.last_mode_hz / peaks.first_mode_hz, 4.0), -0.2 + 1.2 * u[0]);
  switch (kind) {
    case extra_mass:
      return {s * 20};
    case tuned_mass_damper:
      return {s * mass, hz, 0.03 + 0.07 * u[1]};
    case added_spring:
      return {s * k};
    case added_damper:
      return {s * k / w1};
    case unmeasured_force: {
      const double force = s * mass * peaks.accel_rms[b.truth.dof(p.story, p.frame)];
      const bool harmonic = u[1] < 0.6;
      return {harmonic ? force : 0,
              hz,
              6.28 * u[2],
              harmonic ? 0 : force,
              0.5 * peaks.first_mode_hz,
              1.5 * peaks.first_mode_hz,
              std::floor(1e6 * u[3]),
              0};
    }
    default:
      return {};
  }
}

/// Returns the rotational stiffness that contributes `s` of the frames' flexibility.
double rotational_stiffness(const StudyBuilding& b, const estimator::EffectPlace& p, double s,
                            bool base) {
  double sum = 0;
  for (int f = 0; f < b.truth.frames(); ++f)
    if (b.truth.direction(f) == p.direction) sum += b.theta[b.table().frame_stiffness(1, f)];
  const double height = b.truth.stories;
  return (base ? sum : sum / b.truth.n()) * height * height / s;
}

std::vector<double> channel_values(estimator::EffectKind kind, const StudyBuilding& b,
                                   const Peaks& peaks, const estimator::EffectPlace& p, double s,
                                   double sign) {
  const estimator::SensorAxis& axis = b.axes[static_cast<std::size_t>(p.channel)];
  const double rms = axis.story > 0 ? peaks.accel_rms[b.truth.dof(axis.story, axis.frame)] : 0.5;
  switch (kind) {
    case clipping:
      return {4 * rms * (1 - s)};
    case bias_drift:
      return {sign * s * rms / peaks.seconds, 0};
    case gain_error:
    case misalignment:
    case time_shift:
      return {sign * s};
    default:
      return {};
  }
}

}  // namespace

Draw draw_effect(estimator::EffectKind kind, const StudyBuilding& b, const Peaks& peaks,
                 estimator::Random& random) {
  const estimator::EffectPlace place = random_place(kind, b, random);
  const double sign = random.uniform() < 0.5 ? -1 : 1;
  std::vector<double> u;
  for (int i = 0; i < 4; ++i) u.push_back(random.uniform());
  Draw draw;
  draw.name = name_of(kind);
  draw.sizeless = describe(kind).parameters.empty();
  const bool of_channel = is_channel_effect(kind);
  draw.of_channel = of_channel;
  draw.largest = largest_size(kind, sign < 0);
  draw.make = [=](double s, Hidden& hidden) {
    estimator::Effect e = make_effect(kind, place);
    const auto set = [&](const std::vector<double>& values) {
      std::copy(values.begin(), values.end(), e.values.begin());
    };
    using enum estimator::PlaceKind;
    if (kind == amplitude_dependence) {
      set(element_values(kind, frames_scale(b, peaks, place), s, sign, u.data(), peaks.seconds));
    } else if (place.kind == frame || place.kind == panel) {
      const int i = element_of(place, b.table());
      const ElementScale scale{b.theta[i], peaks.deformation[i], peaks.rate[i]};
      set(element_values(kind, scale, s, sign, u.data(), peaks.seconds));
      const bool hysteretic = kind == bilinear_hysteresis || kind == bouc_wen || kind == pinching;
      if (hysteretic) hidden.theta[i] -= e.values[0];  // its share of the frame's stiffness
    } else if (place.kind == building) {
      set({rotational_stiffness(b, place, s, kind == base_rocking)});
    } else if (place.kind == floor) {
      const double k = b.theta[b.table().frame_stiffness(place.story, 0)];
      set({k / s, 0.002 * k / s});
    } else if (of_channel) {
      set(channel_values(kind, b, peaks, place, s, sign));
    } else {
      set(node_values(kind, b, peaks, place, s, u.data()));
    }
    hidden.effects.push_back(e);
  };
  return draw;
}

std::vector<estimator::Effect> in_record(std::vector<estimator::Effect> effects, int record,
                                         double seconds) {
  for (estimator::Effect& e : effects) {
    if (record == 0) break;
    if (e.kind == stiffness_drop)
      e.set("at_s",
            std::round(100 * std::fmod(e.value("at_s") + 0.17 * seconds, 0.7 * seconds)) / 100);
    if (e.kind == unmeasured_force) {
      e.set("phase_rad", e.value("phase_rad") + 2.1 * record);
      e.set("seed", e.value("seed") + 1e6 * record);
    }
  }
  return effects;
}

}  // namespace framewatch::study
