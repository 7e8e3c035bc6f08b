#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// What a linear shear building and perfect accelerometers leave out. Names as in the catalogue.
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

/// Where an effect sits, and which members of EffectPlace say so:
/// frame: story, frame (a frame story); panel: story, panel; node: story, frame (one degree of
/// freedom); node_pair: the same and to_story, on the same frame; crossing: story, crossing (both
/// degrees of freedom there); floor: story; building: direction; whole_frame: frame, in all
/// stories; mode: mode; channel: channel; channel_pair: channel, with_channel.
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

/// Members that a kind does not use stay as they are here, so that == compares places.
struct EffectPlace {
  PlaceKind kind = PlaceKind::frame;
  int story = 0;      ///< 1..N; of the upper node, the floor, ...
  int frame = -1;     ///< 0..n+m-1
  int panel = -1;     ///< 0..panels-1, x span fastest
  int crossing = -1;  ///< y line * x lines + x line, as node_mass is flattened
  int to_story = 0;   ///< 0..story-2: the lower end of a node pair, 0 the ground
  Direction direction = Direction::x;
  int mode = 0;      ///< 1..: in the order of the natural frequencies
  int channel = -1;  ///< index of the sensor axis
  int with_channel = -1;

  bool operator==(const EffectPlace&) const = default;
};

/// One number of an effect. Its key is that of the TOML form, with the unit at its end.
struct EffectParameter {
  std::string_view key;
  std::string_view unit;
  std::optional<double> default_value;  ///< none: must be given
  double min;
  double max;
  bool above_min;  ///< min itself is not allowed
  std::string_view meaning;
};

/// One line of the catalogue.
struct EffectDescription {
  EffectKind kind;
  std::string_view name;
  std::vector<PlaceKind> places;  ///< where it can be
  std::vector<EffectParameter> parameters;
  std::string_view equation;
  std::string_view sign;    ///< what positive and negative values do
  std::string_view source;  ///< publication
};

/// All kinds, in the order of EffectKind. d and v are an element's deformation b'y (Element::b, m)
/// and its rate, m/s; forces are restoring forces added to k d + c v, N.
std::span<const EffectDescription> effect_catalogue();
const EffectDescription& describe(EffectKind kind);
std::string_view name_of(EffectKind kind);
std::optional<EffectKind> find_effect(std::string_view name);
/// Of the sensors rather than of the building.
bool is_channel_effect(EffectKind kind);

/// One effect at one place, values in the order of its description's parameters.
struct Effect {
  EffectKind kind = EffectKind::cubic_stiffness;
  EffectPlace place;
  std::vector<double> values;

  /// Of a parameter that its description has.
  double value(std::string_view key) const;
  void set(std::string_view key, double value);
};

/// With every parameter at its default, 0 where it has none.
Effect make_effect(EffectKind kind, const EffectPlace& place);

/// Every way in which `effect` is impossible in this building; a problem's field is the key of the
/// TOML form. Empty when it is possible.
std::vector<Problem> find_problems(const Effect& effect, const Structure& structure,
                                   const std::vector<SensorAxis>& axes);

/// Every place where the building could have such an effect, in a fixed order.
std::vector<EffectPlace> effect_places(EffectKind kind, const Structure& structure,
                                       const std::vector<SensorAxis>& axes);

/// As people read it: "story 1, frame y2", "channel F1-Y1".
std::string place_text(const EffectPlace& place, const Structure& structure,
                       const std::vector<SensorAxis>& axes);

}  // namespace framewatch::estimator
