// SPDX-License-Identifier: MIT
#include <initializer_list>
#include <utility>
#include <vector>

#include "estimator/structure/effect.h"

namespace framewatch::estimator {
namespace {

using enum EffectKind;

constexpr double kAny = 1e15;
constexpr double kLong_s = 1e6;

/// A value of any size and sign.
EffectParameter either_sign(std::string_view key, std::string_view unit, std::string_view meaning) {
  return {key, unit, std::nullopt, -kAny, kAny, false, meaning};
}

EffectParameter positive(std::string_view key, std::string_view unit, std::string_view meaning) {
  return {key, unit, std::nullopt, 0, kAny, true, meaning};
}

/// The size of an effect; 0 means none.
EffectParameter not_negative(std::string_view key, std::string_view unit,
                             std::string_view meaning) {
  return {key, unit, std::nullopt, 0, kAny, false, meaning};
}

EffectParameter within(std::string_view key, std::string_view unit, std::optional<double> usual,
                       double min, double max, std::string_view meaning) {
  return {key, unit, usual, min, max, false, meaning};
}

constexpr std::string_view kHystereticSign =
    "kh > 0 resists and adds to k until yielding. Dissipates.";

const EffectParameter kHystereticStiffness = not_negative("kh_npm", "N/m", "hysteretic stiffness");
const EffectParameter kYieldDeformation = positive("dy_m", "m", "yield deformation of z");
const EffectParameter kSmoothness =
    within("exponent", "", 2.0, 0.5, 60, "n: sharpness of yielding; 1: round");
const EffectParameter kUnloading =
    within("beta", "", 0.5, 0, 10, "dissipating share of the loop; 0.5: linear unloading");

const EffectParameter kStrengthLoss =
    within("strength_loss", "", 0.0, 0, 10, "a: strength falls by 1/(1 + a e), e = work/(kh dy^2)");
const EffectParameter kStiffnessLoss =
    within("stiffness_loss", "", 0.0, 0, 10, "b: kh falls by 1/(1 + b e) under loading");
const EffectParameter kContactDamping =
    within("cg_nspm", "N*s/m", 0.0, 0, kAny, "cg: contact damping");

constexpr std::string_view kShapes = "m: 1 is hyperbolic, 2.5 nearly tanh, 20 has two slopes";
const EffectParameter kSaturation = within("saturation_m", "m", 0.0, 0, kAny,
                                           "d0: deformation where the change levels off; 0: none");

constexpr std::initializer_list<PlaceKind> kElement = {PlaceKind::frame, PlaceKind::panel};
constexpr std::initializer_list<PlaceKind> kFrame = {PlaceKind::frame};
constexpr std::initializer_list<PlaceKind> kNode = {PlaceKind::node};
constexpr std::initializer_list<PlaceKind> kNodePair = {PlaceKind::node_pair};
constexpr std::initializer_list<PlaceKind> kBuilding = {PlaceKind::building};
constexpr std::initializer_list<PlaceKind> kContact = {PlaceKind::frame, PlaceKind::node_pair};
constexpr std::initializer_list<PlaceKind> kFrames = {PlaceKind::building, PlaceKind::whole_frame};
constexpr std::initializer_list<PlaceKind> kMode = {PlaceKind::mode};
constexpr std::initializer_list<PlaceKind> kChannel = {PlaceKind::channel};
constexpr std::initializer_list<PlaceKind> kChannelPair = {PlaceKind::channel_pair};

std::vector<EffectDescription> elastic_and_hysteretic_laws() {
  return {
      {cubic_stiffness,
       "cubic_stiffness",
       kElement,
       {either_sign("k3_npm3", "N/m^3", "cubic stiffness"), kSaturation,
        within("shape", "", 2.0, 0.1, 60, kShapes)},
       "f = k3 d^3; with d0: f = k3 d0^2 m (d - d/(1 + abs(d/d0)^m)^(1/m))",
       "k3 > 0 hardens, k3 < 0 softens.",
       "Duffing 1918; Wigren and Schoukens 2013 (Silverbox); d0: Richard and Abbott, J. Eng. Mech. "
       "Div. 101 (1975)"},
      {quadratic_stiffness,
       "quadratic_stiffness",
       kElement,
       {either_sign("k2_npm2", "N/m^2", "quadratic stiffness"), kSaturation,
        within("shape", "", 1.0, 0.1, 60, kShapes)},
       "f = k2 d abs(d); with d0: f = k2 d0 m (d - d/(1 + abs(d/d0)^m)^(1/m))",
       "k2 > 0 hardens, k2 < 0 softens, in both directions.",
       "Nayfeh and Mook, Nonlinear Oscillations, 1979; hyperbolic: Kondner, J. Soil Mech. Found. "
       "Div. 89 (1963); d0: Richard and Abbott, J. Eng. Mech. Div. 101 (1975)"},
      {bilinear_hysteresis,
       "bilinear_hysteresis",
       kElement,
       {kHystereticStiffness, kYieldDeformation,
        within("spread", "", 0.0, 0, 1,
               "s: ten springs yield in turn between dy (1 - s) and dy (1 + s); 0: one corner"),
        kStrengthLoss,
        within("sharpness", "", 0.0, 0, 60,
               "n: round yielding, 1 is hyperbolic, instead of s, a and c; 0: none"),
        within("peak_oriented", "", 0.0, 0, 1,
               "1: z returns toward the largest deformation so far, instead of s, a, n and c"),
        within("unloading", "", 0.0, 0, 1,
               "u, with peak_oriented: unloading from the largest deformation P has the slope "
               "(dy/P)^u"),
        within("asymmetry", "", 0.0, -0.95, 0.95,
               "c: yields at (1 + c) dy toward positive, (1 - c) dy toward negative deformation")},
       "f = kh z; z' = v while abs(z) < dy or z v < 0, else 0; with n: z = d/(1 + "
       "abs(d/dy)^n)^(1/n) at first loading, after reversals doubled by Masing's rule; "
       "with peak_oriented: z unloads to 0, then goes straight to dy at the largest deformation so "
       "far of the other side",
       kHystereticSign,
       "Caughey, J. Appl. Mech. 27 (1960); n: Masing 1926, Kondner, J. Soil Mech. Found. Div. 89 "
       "(1963), Richard and Abbott, J. Eng. Mech. Div. 101 (1975); peak_oriented: Clough and "
       "Johnston 1966, Takeda, Sozen and Nielsen, J. Struct. Div. 96 (1970)"},
      {bouc_wen,
       "bouc_wen",
       kElement,
       {kHystereticStiffness, kYieldDeformation, kSmoothness, kUnloading, kStrengthLoss,
        kStiffnessLoss,
        within("loading", "", 1.0, -1, 1, "g: shape of loading; -1: hardening without limit")},
       "f = kh z; z' = v/(1 + b e) (1 - (1 + a e) abs(z/dy)^n (beta sgn(v z) + g - beta)); "
       "e' = z v/dy^2",
       kHystereticSign,
       "Wen, J. Eng. Mech. Div. 102 (1976); losses: Baber and Wen, J. Eng. Mech. Div. 107 (1981)"},
      {pinching,
       "pinching",
       kFrame,
       {kHystereticStiffness,
        kYieldDeformation,
        kSmoothness,
        kUnloading,
        within("slip_ratio", "", std::nullopt, 0, 0.99,
               "p: share of the stiffness lost at small force"),
        {"slip_width", "", 0.2, 0, 50, true, "w: half width of the slip zone over dy"},
        within("slip_offset", "", 0.0, -1, 1, "q: position of the slip zone along v"),
        within("slip_work", "", 0.0, 0, 1e6, "E: work e to open the slip zone; 0: open at once"),
        within("slip_lock", "", 0.0, 0, 1, "1: slip zone at zero deformation, not force"),
        kStrengthLoss,
        kStiffnessLoss,
        within("slack", "", 0.0, 0, 1, "1: a brace with slack from its yielding, instead of z"),
        within("play_m", "m", 0.0, 0, kAny, "initial slack of the brace")},
       "f = kh z; z' = h v/(1 + b e) (1 - (1 + a e) abs(z/dy)^n (beta sgn(v z) + 1 - beta)); "
       "h = 1 - p (1 - exp(-e/E)) exp(-((z/dy sgn(v) - q)/w)^2), or with slip_lock d/dy in place "
       "of "
       "z/dy sgn(v) - q; e' = z v/dy^2; with slack f = kh (clip(d - u, 0, dy) - clip(-d - w, 0, "
       "dy)), "
       "u = max(play, largest d so far - dy), w the same of -d",
       "Equals bouc_wen for p = 0.",
       "Baber and Noori, J. Eng. Mech. 111 (1985); Foliente, J. Struct. Eng. 121 (1995); slack: "
       "Tremblay and Filiatrault, Earthquake Eng. Struct. Dyn. 25 (1996)"},
  };
}

std::vector<EffectDescription> friction_contact_and_weight() {
  return {
      {coulomb_friction,
       "coulomb_friction",
       kElement,
       {not_negative("fc_n", "N", "friction force"),
        positive("v0_mps", "m/s", "velocity below which friction is smoothed"),
        within("stick_npm", "N/m", 0.0, 0, kAny,
               "ks: sticking stiffness, instead of v0 and s; 0: rigid"),
        within("static_ratio", "", 0.0, -0.9, 10, "s: fc (1 + s) when sliding starts"),
        {"stribeck_mps", "m/s", 1.0, 0, kAny, true, "vs: velocity above which s vanishes"},
        within("presliding_m", "m", 0.0, 0, kAny, "dp: deformation before sliding; 0: none")},
       "f = fc g(v), g(v) = (1 + s exp(-(v/vs)^2)) tanh(v/v0); with dp: f = fc z; z' = (v - v z / "
       "g(v)) / dp; with ks: f = ks z; z' = v while abs(z) < fc/ks or z v < 0, else 0",
       "fc > 0 resists the velocity. Dissipates.",
       "Den Hartog, Trans. ASME 53 (1931); Armstrong-Helouvry et al., Automatica 30 (1994); "
       "Canudas de Wit et al., IEEE Trans. Autom. Control 40 (1995)"},
      {quadratic_damping,
       "quadratic_damping",
       kFrame,
       {not_negative("c2_ns2pm2", "N*s^2/m^2", "quadratic damping")},
       "f = c2 v abs(v)",
       "c2 > 0 resists the velocity. Dissipates.",
       "Nayfeh and Mook, Nonlinear Oscillations, 1979"},
      {amplitude_dependence,
       "amplitude_dependence",
       kFrames,
       {within("softening", "", std::nullopt, -10, 1,
               "r: share of stiffness lost at deformation at_m"),
        positive("at_m", "m", "D: reference deformation"),
        within("exponent", "", 2.0, 1, 9, "p: exponent of the deformation"),
        within("damping_s2pm", "s^2/m", 0.0, -kAny, kAny, "g: coefficient of the squared rate"),
        within("slip", "", 0.0, 0, 1, "s: share of softening from joint slip"), kSaturation},
       "f = k (-r D ((1 - s) y(x) + s z(x)) + g v abs(v)), x = d/D, in every story of the frame or "
       "direction; y(x) = x abs(x)^(p - 1); with d0: y(x) = u(x)/u(1), u(x) = x - x/(1 + abs(x "
       "D/d0)^m)^(1/m), m = p - 1; z(x) = y(x) at first loading, after reversals doubled by "
       "Masing's rule",
       "r > 0 softens, g > 0 resists the velocity. Joint slip dissipates. p = 2 with d0 is "
       "hyperbolic.",
       "Nayfeh and Mook, Nonlinear Oscillations, 1979; Iwan, J. Appl. Mech. 33 (1966); d0: Richard "
       "and Abbott, J. Eng. Mech. Div. 101 (1975)"},
      {one_sided_gap,
       "one_sided_gap",
       kContact,
       {not_negative("kg_npm", "N/m", "stiffness in contact"),
        within("gap_m", "m", std::nullopt, 0, kAny, "g: deformation at first contact"),
        within("side", "", 1.0, -1, 1, "s: 1 closes at positive deformation, -1 at negative"),
        kContactDamping},
       "f = s max(kg (s d - g) + cg s v, 0) while s d > g; with to_story, d is between two floors "
       "(0: the ground)",
       "kg > 0 pushes back.",
       "Anagnostopoulos, Earthquake Eng. Struct. Dyn. 16 (1988)"},
      {two_sided_gap,
       "two_sided_gap",
       kContact,
       {not_negative("kg_npm", "N/m", "stiffness in contact"),
        within("gap_m", "m", std::nullopt, 0, kAny, "g: deformation at first contact"),
        kContactDamping},
       "as one_sided_gap, in both directions",
       "kg > 0 pushes back, such as a brace with play.",
       "Anagnostopoulos, Earthquake Eng. Struct. Dyn. 16 (1988)"},
      {p_delta,
       "p_delta",
       kFrame,
       {not_negative("weight_n", "N", "W: weight carried by the frame story")},
       "f = -(W/h) d, h the story height",
       "W > 0 weakens. Equivalent to a lower k, unless weights are known.",
       "Wilson and Habibullah, Eng. J. AISC 24 (1987)"},
  };
}

std::vector<EffectDescription> masses_and_rotations() {
  return {
      {extra_mass,
       "extra_mass",
       {PlaceKind::crossing},
       {either_sign("mass_kg", "kg", "dm: mass added to node_mass_kg")},
       "adds dm y'' and dm times the ground acceleration at the crossing, in both directions",
       "dm > 0 is heavier than configured.",
       "Newton"},
      {tuned_mass_damper,
       "tuned_mass_damper",
       kNode,
       {not_negative("mass_kg", "kg", "m: hidden mass, not in node_mass_kg"),
        positive("frequency_hz", "Hz", "F: frequency with the floor fixed"),
        within("damping_ratio", "", std::nullopt, 0, 2, "h: damping ratio of the absorber")},
       "m (q'' + a_abs) + c q' + k q = 0, q relative to the node, a_abs its absolute acceleration; "
       "k = m (2 pi F)^2; c = 2 h m 2 pi F; k q + c q' pulls the node",
       "q > 0 pulls toward positive.",
       "Den Hartog, Mechanical Vibrations, 1956"},
      {base_rocking,
       "base_rocking",
       kBuilding,
       {positive("kr_nmprad", "N*m/rad", "K: rotational stiffness of the base")},
       "d = drift - h_i phi in every story and frame of the direction, phi the base's rotation; K "
       "phi = sum over stories of h_i k d; dashpots and added laws use this d",
       "Smaller K is softer; 1/K = 0 is rigid. phi > 0 leans toward positive.",
       "Veletsos and Meek, Earthquake Eng. Struct. Dyn. 3 (1974)"},
      {frame_bending,
       "frame_bending",
       kBuilding,
       {positive("kr_nmprad", "N*m/rad", "K: rotational stiffness per frame and floor")},
       "d_i = drift_i - h_i sum over j < i of phi_j, a hinge at every floor j = 0..N-1 of each "
       "frame of the direction; K phi_j = sum over i > j of h_i k_i d_i; dashpots and added laws "
       "use this d",
       "Smaller K is softer; 1/K = 0 is rigid. phi > 0 leans toward positive.",
       "Stafford Smith and Coull, Tall Building Structures, 1991"},
  };
}

std::vector<EffectDescription> springs_dampers_and_changes() {
  return {
      {added_spring,
       "added_spring",
       kNodePair,
       {either_sign("k_npm", "N/m", "k: stiffness")},
       "f = k (y_story - y_to_story), on one frame",
       "k > 0 resists.",
       "Hooke"},
      {added_damper,
       "added_damper",
       kNodePair,
       {not_negative("c_nspm", "N*s/m", "c: damping")},
       "f = c (y'_story - y'_to_story), on one frame",
       "c > 0 resists. Dissipates.",
       "Newton"},
      {modal_damping,
       "modal_damping",
       kMode,
       {within("damping_ratio", "", std::nullopt, 0, 2, "h: added to the ratio from dashpots")},
       "f = 2 h w M phi phi' M y', phi the mode's shape with phi' M phi = 1, w its undamped "
       "circular frequency; of other effects, only base_rocking and frame_bending count",
       "h > 0 resists. Dissipates. h = a/(2 w) in every mode equals damping a M.",
       "Wilson and Penzien, Earthquake Eng. Struct. Dyn. 1 (1972)"},
      {stiffness_drop,
       "stiffness_drop",
       kElement,
       {either_sign("dk_npm", "N/m", "dk: change of stiffness"),
        within("at_s", "s", std::nullopt, 0, kLong_s, "t0: time of the drop")},
       "f = dk d from t0 on",
       "dk < 0 loses stiffness.",
       "Shintani et al., Front. Built Environ. 5:103 (2019)"},
      {stiffness_drift,
       "stiffness_drift",
       kElement,
       {either_sign("dk_npm", "N/m", "dk: final change of stiffness"),
        within("from_s", "s", 0.0, 0, kLong_s, "t0: start"),
        {"duration_s", "s", std::nullopt, 0, kLong_s, true, "T: duration"}},
       "f = dk clip((t - t0)/T, 0, 1) d",
       "dk < 0 loses stiffness.",
       "Clinton et al., Bull. Seismol. Soc. Am. 96 (2006)"},
  };
}

std::vector<EffectDescription> floors_and_forces() {
  return {
      {floor_flexibility,
       "floor_flexibility",
       {PlaceKind::floor},
       {positive("gk_nprad", "N/(rad*m)", "G: shear stiffness of each panel"),
        not_negative("gc_nsprad", "N*s/(rad*m)", "damping of each panel")},
       "one floor of a building with floor = \"rigid\" becomes flexible",
       "Smaller G is softer; 1/G = 0 is rigid.",
       "Shintani et al., Front. Built Environ. 5:103 (2019), equation (12)"},
      {unmeasured_force,
       "unmeasured_force",
       kNode,
       {within("amplitude_n", "N", 0.0, 0, kAny, "F: harmonic amplitude"),
        {"frequency_hz", "Hz", 1.0, 0, 1e4, true, "f: harmonic frequency"},
        within("phase_rad", "rad", 0.0, -100, 100, "p: harmonic phase"),
        within("rms_n", "N", 0.0, 0, kAny, "rms of a stationary Gaussian force"),
        within("low_hz", "Hz", 0.1, 0, 1e4, "lower end of its flat band"),
        {"high_hz", "Hz", 10.0, 0, 1e4, true, "upper end of its flat band"},
        within("seed", "", 1.0, 0, 9e15, "seed of the Gaussian force"),
        within("from_s", "s", 0.0, 0, kLong_s, "start of the force")},
       "p(t) = F sin(2 pi f t + p) + Gaussian force, on one degree of freedom",
       "Positive pushes toward +x or +y.",
       "Chopra, Dynamics of Structures, 2017"},
  };
}

std::vector<EffectDescription> sensor_errors() {
  return {
      {gain_error,
       "gain_error",
       kChannel,
       {within("gain", "", std::nullopt, -1, 100, "g: relative error")},
       "out = (1 + g) a",
       "g > 0 reads too much.",
       "IEEE Std 1293"},
      {polarity, "polarity", kChannel, {}, "out = -a", "", "IEEE Std 1293"},
      {misalignment,
       "misalignment",
       kChannelPair,
       {within("angle_deg", "deg", std::nullopt, -90, 90, "q: from the channel's axis")},
       "out = cos(q) a + sin(q) a_with",
       "q > 0 turns the axis toward that of with_channel.",
       "IEEE Std 1293"},
      {time_shift,
       "time_shift",
       kChannel,
       {within("shift_s", "s", std::nullopt, -0.5, 0.5, "T: delay")},
       "out(t) = a(t - T)",
       "T > 0 is late.",
       "definition"},
      {clipping,
       "clipping",
       kChannel,
       {positive("level_mps2", "m/s^2", "L: largest magnitude")},
       "out = min(max(a, -L), L)",
       "",
       "IEEE Std 1293"},
      {bias_drift,
       "bias_drift",
       kChannel,
       {either_sign("ramp_mps3", "m/s^2 per s", "slope"),
        within("from_s", "s", 0.0, 0, kLong_s, "t0: start")},
       "out = a + ramp max(t - t0, 0)",
       "ramp > 0 rises.",
       "IEEE Std 1293"},
      {swapped, "swapped", kChannelPair, {}, "out = a_with, out_with = a", "", "wiring"},
  };
}

/// Returns the descriptions in the order of EffectKind.
std::vector<EffectDescription> make_catalogue() {
  std::vector<EffectDescription> out;
  for (const auto& part :
       {elastic_and_hysteretic_laws, friction_contact_and_weight, masses_and_rotations,
        springs_dampers_and_changes, floors_and_forces, sensor_errors})
    for (EffectDescription& description : part()) out.push_back(std::move(description));
  return out;
}

}  // namespace

std::span<const EffectDescription> effect_catalogue() {
  static const std::vector<EffectDescription> kCatalogue = make_catalogue();
  return kCatalogue;
}

}  // namespace framewatch::estimator
