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

/// A value of at least 0. It is the size of an effect: 0 switches the effect off.
EffectParameter not_negative(std::string_view key, std::string_view unit,
                             std::string_view meaning) {
  return {key, unit, std::nullopt, 0, kAny, false, meaning};
}

EffectParameter within(std::string_view key, std::string_view unit, std::optional<double> usual,
                       double min, double max, std::string_view meaning) {
  return {key, unit, usual, min, max, false, meaning};
}

constexpr std::string_view kHystereticSign =
    "kh > 0 resists. It comes on top of k: k + kh at first, k after yielding. Dissipates.";

const EffectParameter kHystereticStiffness =
    not_negative("kh_npm", "N/m", "stiffness of the hysteretic part");
const EffectParameter kYieldDeformation =
    positive("dy_m", "m", "largest elastic deformation z of the hysteretic part");
const EffectParameter kSmoothness =
    within("exponent", "", 2.0, 0.5, 60, "n: sharpness of yielding, 1 round");
const EffectParameter kUnloading = within(
    "beta", "", 0.5, 0, 10,
    "share of the loop's shape that dissipates; 0.5: unloading is linear, more: it stiffens");

const EffectParameter kStrengthLoss =
    within("strength_loss", "", 0.0, 0, 10,
           "a: strength falls by 1/(1 + a e), e the work of the hysteretic part over kh dy^2");
const EffectParameter kStiffnessLoss =
    within("stiffness_loss", "", 0.0, 0, 10, "b: kh falls by 1/(1 + b e) while it loads");
const EffectParameter kContactDamping =
    within("cg_nspm", "N*s/m", 0.0, 0, kAny, "cg: dashpot beside the contact's spring");

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
       {either_sign("k3_npm3", "N/m^3", "cubic stiffness")},
       "f = k3 d^3",
       "k3 > 0 hardens, k3 < 0 softens.",
       "Duffing 1918; Wigren and Schoukens 2013 (Silverbox)"},
      {quadratic_stiffness,
       "quadratic_stiffness",
       kElement,
       {either_sign("k2_npm2", "N/m^2", "quadratic stiffness")},
       "f = k2 d abs(d)",
       "k2 > 0 hardens, k2 < 0 softens, alike in both directions.",
       "Nayfeh and Mook, Nonlinear Oscillations, 1979"},
      {bilinear_hysteresis,
       "bilinear_hysteresis",
       kElement,
       {kHystereticStiffness, kYieldDeformation,
        within("spread", "", 0.0, 0, 1,
               "s: the part is ten springs that yield one after the other, between dy (1 - s) and "
               "dy (1 + s); 0: a single corner"),
        kStrengthLoss},
       "f = kh z; z' = v while abs(z) < dy or z v < 0, else 0",
       kHystereticSign,
       "Caughey, J. Appl. Mech. 27 (1960)"},
      {bouc_wen,
       "bouc_wen",
       kElement,
       {kHystereticStiffness, kYieldDeformation, kSmoothness, kUnloading, kStrengthLoss,
        kStiffnessLoss,
        within("loading", "", 1.0, -1, 1,
               "g: share of the loop's shape while it loads; -1: it hardens, without an end")},
       "f = kh z; z' = v/(1 + b e) (1 - (1 + a e) abs(z/dy)^n (beta sgn(v z) + g - beta)); "
       "e' = z v/dy^2",
       kHystereticSign,
       "Wen, J. Eng. Mech. Div. 102 (1976), normalized so that z ends at dy; losses: Baber and "
       "Wen, J. Eng. Mech. Div. 107 (1981)"},
      {pinching,
       "pinching",
       kFrame,
       {kHystereticStiffness,
        kYieldDeformation,
        kSmoothness,
        kUnloading,
        within("slip_ratio", "", std::nullopt, 0, 0.99,
               "p: share of the stiffness that is lost where the force is small"),
        {"slip_width", "", 0.2, 0, 50, true, "w: half width of the slip zone, in units of dy"},
        within("slip_offset", "", 0.0, -1, 1, "q: where the slip zone is, in the direction of v"),
        within("slip_work", "", 0.0, 0, 1e6, "E: work e in which it opens; 0: open from the start"),
        within("slip_lock", "", 0.0, 0, 1, "1: the slip zone is about zero deformation, not force"),
        kStrengthLoss,
        kStiffnessLoss,
        within("slack", "", 0.0, 0, 1,
               "1: a brace that yields and is slack by what it has yielded, in place of z"),
        within("play_m", "m", 0.0, 0, kAny, "of such a brace: deformation that is slack at first")},
       "f = kh z; z' = h v/(1 + b e) (1 - (1 + a e) abs(z/dy)^n (beta sgn(v z) + 1 - beta)); "
       "h = 1 - p (1 - exp(-e/E)) exp(-((z/dy sgn(v) - q)/w)^2), or with slip_lock d/dy in place "
       "of "
       "z/dy sgn(v) - q; e' = z v/dy^2; with slack f = kh (clip(d - u, 0, dy) - clip(-d - w, 0, "
       "dy)), "
       "u = max(play, largest d so far - dy), w the same of -d",
       "As bouc_wen; p = 0 is bouc_wen.",
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
        positive("v0_mps", "m/s", "velocity below which the force gives way smoothly"),
        within("stick_npm", "N/m", 0.0, 0, kAny,
               "ks: slope while it sticks, in place of v0 and s; 0: rigid"),
        within("static_ratio", "", 0.0, -0.9, 10, "s: fc (1 + s) at the onset of sliding"),
        {"stribeck_mps", "m/s", 1.0, 0, kAny, true, "vs: velocity above which s is gone"},
        within("presliding_m", "m", 0.0, 0, kAny,
               "dp: deformation that it takes before it slides; 0: none")},
       "f = fc g(v), g(v) = (1 + s exp(-(v/vs)^2)) tanh(v/v0); with dp: f = fc z; z' = (v - v z / "
       "g(v)) / dp; with ks: f = ks z; z' = v while abs(z) < fc/ks or z v < 0, else 0",
       "fc > 0 resists the velocity. Dissipates.",
       "Den Hartog, Trans. ASME 53 (1931), regularized; Armstrong-Helouvry, Dupont and Canudas de "
       "Wit, Automatica 30 (1994); Canudas de Wit and others, IEEE Trans. Autom. Control 40 "
       "(1995)"},
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
               "r: share of their stiffness that all elements lose at the deformation at_m"),
        positive("at_m", "m", "D: that deformation"),
        within("exponent", "", 2.0, 1, 9, "p: of the deformation"),
        within("damping_s2pm", "s^2/m", 0.0, -kAny, kAny, "g: of the squared rate"),
        within("slip", "", 0.0, 0, 1, "s: share of the softening that is slip in joints")},
       "f = k (-r D ((1 - s) x abs(x)^(p - 1) + s z(x)) + g v abs(v)), x = d/D, in every story of "
       "the frame, or of all frames of the direction; z(x) is x abs(x)^(p - 1) at first loading "
       "and, from every reversal on, twice that curve at half the size (Masing)",
       "r > 0 softens, g > 0 resists the velocity. Dissipates where joints slip.",
       "Nayfeh and Mook, Nonlinear Oscillations, 1979; Iwan, J. Appl. Mech. 33 (1966)"},
      {one_sided_gap,
       "one_sided_gap",
       kContact,
       {not_negative("kg_npm", "N/m", "stiffness in contact"),
        within("gap_m", "m", std::nullopt, 0, kAny, "g: deformation at first contact"),
        within("side", "", 1.0, -1, 1, "s: 1 closes toward positive deformation, -1 negative"),
        kContactDamping},
       "f = s max(kg (s d - g) + cg s v, 0) while s d > g; with to_story (0: the ground) d is "
       "between two floors: a stop",
       "kg > 0 pushes back.",
       "Anagnostopoulos, Earthquake Eng. Struct. Dyn. 16 (1988)"},
      {two_sided_gap,
       "two_sided_gap",
       kContact,
       {not_negative("kg_npm", "N/m", "stiffness in contact"),
        within("gap_m", "m", std::nullopt, 0, kAny, "g: deformation at first contact"),
        kContactDamping},
       "one_sided_gap toward both sides",
       "kg > 0 pushes back. A brace with play.",
       "Anagnostopoulos, Earthquake Eng. Struct. Dyn. 16 (1988)"},
      {p_delta,
       "p_delta",
       kFrame,
       {not_negative("weight_n", "N", "W: weight that the frame story carries")},
       "f = -(W/h) d, h the story height",
       "W > 0 weakens. The same as a lower k: only known weights tell them apart.",
       "Wilson and Habibullah, Eng. J. AISC 24 (1987)"},
  };
}

std::vector<EffectDescription> masses_and_rotations() {
  return {
      {extra_mass,
       "extra_mass",
       {PlaceKind::crossing},
       {either_sign("mass_kg", "kg", "mass beside node_mass_kg")},
       "m y'' grows by dm y'' in both directions at the crossing, and so does its inertia under "
       "the ground's acceleration",
       "dm > 0: heavier than configured.",
       "Newton's second law"},
      {tuned_mass_damper,
       "tuned_mass_damper",
       kNode,
       {not_negative("mass_kg", "kg", "m: hidden mass, beside node_mass_kg"),
        positive("frequency_hz", "Hz", "F: of the mass on its spring, the floor held"),
        within("damping_ratio", "", std::nullopt, 0, 2,
               "h: of the mass on its spring, the floor held")},
       "m (q'' + a_abs) + c q' + k q = 0, q relative to the node, a_abs its absolute acceleration; "
       "k = m (2 pi F)^2; c = 2 h m 2 pi F; k q + c q' pulls the node",
       "q > 0 pulls the node toward positive.",
       "Den Hartog, Mechanical Vibrations, 1956"},
      {base_rocking,
       "base_rocking",
       kBuilding,
       {positive("kr_nmprad", "N*m/rad", "K: rotational stiffness of the base")},
       "every story's frames of the direction deform by d = drift - h_i phi, phi the base's "
       "rotation; K phi = sum over stories of h_i k d (moment of the elastic story shears); "
       "dashpots and added laws take the same d",
       "Smaller K is softer; 1/K = 0 is rigid. phi > 0 leans toward positive.",
       "Veletsos and Meek, Earthquake Eng. Struct. Dyn. 3 (1974), without rotary inertia"},
      {frame_bending,
       "frame_bending",
       kBuilding,
       {positive("kr_nmprad", "N*m/rad", "K: rotational stiffness of every frame at every floor")},
       "in each frame of the direction a hinge at every floor j = 0..N-1 turns all above it: "
       "d_i = drift_i - h_i sum over j < i of phi_j; K phi_j = sum over i > j of h_i k_i d_i; "
       "dashpots and added laws take the same d",
       "Smaller K is softer; 1/K = 0 is rigid. phi > 0 leans toward positive.",
       "Stafford Smith and Coull, Tall Building Structures, 1991, columns as hinged segments"},
  };
}

std::vector<EffectDescription> springs_dampers_and_changes() {
  return {
      {added_spring,
       "added_spring",
       kNodePair,
       {either_sign("k_npm", "N/m", "stiffness between the two floors")},
       "f = k (y_story - y_to_story), on one frame",
       "k > 0 resists.",
       "Hooke's law"},
      {added_damper,
       "added_damper",
       kNodePair,
       {not_negative("c_nspm", "N*s/m", "dashpot between the two floors")},
       "f = c (y'_story - y'_to_story), on one frame; to_story = 0: the base",
       "c > 0 resists. Dissipates.",
       "Newton's law of viscosity"},
      {modal_damping,
       "modal_damping",
       kMode,
       {within("damping_ratio", "", std::nullopt, 0, 2, "h: beside what dashpots give the mode")},
       "f = 2 h w M phi phi' M y', phi the mode's shape, phi' M phi = 1, w its natural circular "
       "frequency; both without damping and other effects than base_rocking and frame_bending",
       "h > 0 resists. Dissipates. h = a/(2 w) in every mode is a damping a M.",
       "Wilson and Penzien, Earthquake Eng. Struct. Dyn. 1 (1972)"},
      {stiffness_drop,
       "stiffness_drop",
       kElement,
       {either_sign("dk_npm", "N/m", "change of the stiffness"),
        within("at_s", "s", std::nullopt, 0, kLong_s, "t0: when")},
       "f = dk d from t0 on",
       "dk < 0 loses stiffness.",
       "Shintani, Yoshitomi and Takewaki, Front. Built Environ. 5:103 (2019), section on damage"},
      {stiffness_drift,
       "stiffness_drift",
       kElement,
       {either_sign("dk_npm", "N/m", "change of the stiffness at the end"),
        within("from_s", "s", 0.0, 0, kLong_s, "t0: when it begins"),
        {"duration_s", "s", std::nullopt, 0, kLong_s, true, "T: how long it takes"}},
       "f = dk clip((t - t0)/T, 0, 1) d",
       "dk < 0 loses stiffness.",
       "Clinton et al., Bull. Seismol. Soc. Am. 96 (2006): wander of frequencies"},
  };
}

std::vector<EffectDescription> floors_and_forces() {
  return {
      {floor_flexibility,
       "floor_flexibility",
       {PlaceKind::floor},
       {positive("gk_nprad", "N/(rad*m)", "G: shear stiffness of each panel of the floor"),
        not_negative("gc_nsprad", "N*s/(rad*m)", "its damping")},
       "the floor of a building with floor = \"rigid\" moves as with floor = \"flexible\"",
       "Smaller G is softer; 1/G = 0 is rigid.",
       "Shintani, Yoshitomi and Takewaki, Front. Built Environ. 5:103 (2019), equation (12)"},
      {unmeasured_force,
       "unmeasured_force",
       kNode,
       {within("amplitude_n", "N", 0.0, 0, kAny, "F: of a harmonic force"),
        {"frequency_hz", "Hz", 1.0, 0, 1e4, true, "f: of the harmonic force"},
        within("phase_rad", "rad", 0.0, -100, 100, "p: of the harmonic force"),
        within("rms_n", "N", 0.0, 0, kAny, "of a stationary Gaussian force with a flat band"),
        within("low_hz", "Hz", 0.1, 0, 1e4, "the band's lower end"),
        {"high_hz", "Hz", 10.0, 0, 1e4, true, "the band's upper end"},
        within("seed", "", 1.0, 0, 9e15, "of the Gaussian force"),
        within("from_s", "s", 0.0, 0, kLong_s, "no force before")},
       "p(t) = F sin(2 pi f t + p) + Gaussian force, on one degree of freedom",
       "Positive pushes toward +x or +y.",
       "Wind and machines: Chopra, Dynamics of Structures, 2017"},
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
       "T > 0: the channel is late.",
       "definition of a delay"},
      {clipping,
       "clipping",
       kChannel,
       {positive("level_mps2", "m/s^2", "L: largest value")},
       "out = min(max(a, -L), L)",
       "",
       "IEEE Std 1293"},
      {bias_drift,
       "bias_drift",
       kChannel,
       {either_sign("ramp_mps3", "m/s^2 per s", "slope"),
        within("from_s", "s", 0.0, 0, kLong_s, "t0: when it begins")},
       "out = a + ramp max(t - t0, 0)",
       "ramp > 0 rises.",
       "IEEE Std 1293"},
      {swapped,
       "swapped",
       kChannelPair,
       {},
       "out = a_with, out_with = a: the two channels' motions are exchanged",
       "",
       "wiring"},
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
