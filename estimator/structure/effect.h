// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Deviations from a linear shear building with perfect accelerometers. Enumerators are named as in
/// the catalogue.
enum class EffectKind {
  cubic_stiffness,
  quadratic_stiffness,
  bilinear_hysteresis,
  bouc_wen,
  pinching,
  coulomb_friction,
  quadratic_damping,
  amplitude_dependence,
  one_sided_gap,
  two_sided_gap,
  p_delta,
  extra_mass,
  tuned_mass_damper,
  base_rocking,
  frame_bending,
  added_spring,
  added_damper,
  modal_damping,
  stiffness_drop,
  stiffness_drift,
  floor_flexibility,
  unmeasured_force,
  gain_error,
  polarity,
  misalignment,
  time_shift,
  clipping,
  bias_drift,
  swapped,
};

/// The kind of place where an effect sits. These members of EffectPlace identify the place:
///   frame         story, frame: a frame story
///   panel         story, panel
///   node          story, frame: one degree of freedom
///   node_pair     story, to_story, frame
///   crossing      story, crossing: both degrees of freedom there
///   floor         story
///   building      direction
///   whole_frame   frame, in all stories
///   mode          mode
///   channel       channel
///   channel_pair  channel, with_channel
enum class PlaceKind {
  frame,
  panel,
  node,
  node_pair,
  crossing,
  floor,
  building,
  whole_frame,
  mode,
  channel,
  channel_pair
};

/// A place. Members that its kind does not use keep their default, so that == compares places.
struct EffectPlace {
  PlaceKind kind = PlaceKind::frame;
  int story = 0;      ///< 1..N; the floor, or the upper end of a node pair
  int frame = -1;     ///< 0..n+m-1
  int panel = -1;     ///< 0..panels-1, x span fastest
  int crossing = -1;  ///< y line * x lines + x line, as node_mass is flattened
  int to_story = 0;   ///< 0..story-2: the lower end of a node pair, 0 the ground
  Direction direction = Direction::x;
  int mode = 0;      ///< 1.., in the order of the natural frequencies
  int channel = -1;  ///< index of the sensor axis
  int with_channel = -1;

  bool operator==(const EffectPlace&) const = default;
};

/// One parameter of an effect. Its key is the one of the TOML form and ends with the unit.
struct EffectParameter {
  std::string_view key;
  std::string_view unit;
  std::optional<double> default_value;  ///< empty: the parameter is required
  double min;
  double max;
  bool above_min;  ///< the value must exceed min
  std::string_view meaning;
};

/// One entry of the catalogue.
struct EffectDescription {
  EffectKind kind;
  std::string_view name;
  std::vector<PlaceKind> places;  ///< kinds of place where the effect can be
  std::vector<EffectParameter> parameters;
  std::string_view equation;
  std::string_view sign;    ///< what positive and negative values do
  std::string_view source;  ///< publication
};

/// Returns the descriptions of all kinds in the order of EffectKind. In their equations d is an
/// element's deformation b'y (Element::b, m) and v its rate, m/s. Forces are restoring forces added
/// to k d + c v, N.
std::span<const EffectDescription> effect_catalogue();
const EffectDescription& describe(EffectKind kind);
std::string_view name_of(EffectKind kind);
std::optional<EffectKind> find_effect(std::string_view name);
/// Returns true for an effect of a sensor, false for one of the building.
bool is_channel_effect(EffectKind kind);

/// One effect at one place. `values` follow the order of its description's parameters.
struct Effect {
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  std::vector<double> values;

  /// Returns or sets one parameter. `key` must be in the effect's description.
  double value(std::string_view key) const;
  void set(std::string_view key, double value);
};

/// Returns an effect with every parameter at its default, or at 0 without a default.
Effect make_effect(EffectKind kind, const EffectPlace& place);

/// Returns every reason why `effect` is impossible in this building; empty if it is possible. A
/// problem's field is the key of the TOML form.
std::vector<Problem> find_problems(const Effect& effect, const Structure& structure,
                                   const std::vector<SensorAxis>& axes);

/// Returns every place where the building can have such an effect, in a fixed order.
std::vector<EffectPlace> effect_places(EffectKind kind, const Structure& structure,
                                       const std::vector<SensorAxis>& axes);

/// Returns a readable name of the place: "story 1, frame y2", "channel F1-Y1".
std::string place_text(const EffectPlace& place, const Structure& structure,
                       const std::vector<SensorAxis>& axes);

}  // namespace framewatch::estimator
