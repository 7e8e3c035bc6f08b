#include "estimator/diagnose/catalogue_form.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

void set_axis_values(Effect& out, const std::vector<Stretch>& stretches, const Model& model) {
  const auto axis = static_cast<Eigen::Index>(out.place.channel);
  switch (out.kind) {
    case EffectKind::gain_error:
      out.set("gain", model.gain[axis]);
      break;
    case EffectKind::time_shift:
      out.set("shift_s", model.clock_s[axis]);
      break;
    case EffectKind::clipping: {
      double level = 1e300;
      for (const Stretch& s : stretches)
        level =
            std::min(level, 0.5 * (s.accel.col(axis).maxCoeff() - s.accel.col(axis).minCoeff()));
      out.set("level_mps2", level);
      break;
    }
    default:
      break;
  }
}

}  // namespace

Effect catalogue_effect(const Plant&, const std::vector<Stretch>& stretches,
                        const FoundEffect& found, const Model& model) {
  Effect out = make_effect(found.chosen.kind, found.chosen.place);
  if (found.index < 0) {
    set_axis_values(out, stretches, model);
    return out;
  }
  const ModelEffect& e = model.effects[static_cast<std::size_t>(found.index)];
  const auto p = [&](std::size_t i) { return e.knobs[i].plain(); };
  switch (out.kind) {
    case EffectKind::cubic_stiffness:
      out.set("k3_npm3", p(0) / std::pow(e.deformation, 3));
      break;
    case EffectKind::quadratic_stiffness:
      out.set("k2_npm2", p(0) / std::pow(e.deformation, 2));
      break;
    case EffectKind::bilinear_hysteresis:
      out.set("kh_npm", p(0));
      out.set("dy_m", p(1));
      break;
    case EffectKind::bouc_wen:
    case EffectKind::pinching:
      out.set("kh_npm", p(0));
      out.set("dy_m", p(1));
      out.set("exponent", p(2));
      out.set("beta", p(3));
      if (out.kind == EffectKind::pinching) {
        out.set("slip_ratio", p(4));
        out.set("slip_width", p(5));
      }
      break;
    case EffectKind::coulomb_friction:
      out.set("fc_n", e.form == LawForm::hysteresis ? p(0) * p(1) : p(0));
      out.set("v0_mps", e.form == LawForm::hysteresis ? 1e-3 * e.rate : p(1));
      break;
    case EffectKind::quadratic_damping:
      out.set("c2_ns2pm2", p(0) / (e.rate * e.rate));
      break;
    case EffectKind::one_sided_gap:
    case EffectKind::two_sided_gap:
      out.set("kg_npm", p(0));
      out.set("gap_m", p(1));
      if (out.kind == EffectKind::one_sided_gap)
        out.set("side", e.form == LawForm::gap_positive ? 1.0 : -1.0);
      break;
    case EffectKind::stiffness_drop:
      out.set("dk_npm", p(0));
      out.set("at_s", std::max(0.0, e.record_knobs[0][0].plain()));
      break;
    case EffectKind::stiffness_drift:
      out.set("dk_npm", p(0));
      out.set("from_s", std::max(0.0, e.record_knobs[0][0].plain()));
      out.set("duration_s", e.record_knobs[0][1].plain());
      break;
    case EffectKind::extra_mass:
      out.set("mass_kg", p(0));
      break;
    case EffectKind::tuned_mass_damper:
      out.set("mass_kg", p(0));
      out.set("frequency_hz", p(1));
      out.set("damping_ratio", p(2));
      break;
    case EffectKind::base_rocking:
    case EffectKind::frame_bending:
      out.set("kr_nmprad", 1 / std::max(p(0), 1e-14));
      break;
    case EffectKind::added_spring:
      out.set("k_npm", p(0));
      break;
    case EffectKind::added_damper:
      out.set("c_nspm", p(0));
      break;
    case EffectKind::unmeasured_force: {
      const double c = e.record_knobs[0][0].plain(), s = e.record_knobs[0][1].plain();
      out.set("amplitude_n", std::hypot(c, s));
      out.set("frequency_hz", p(0));
      out.set("phase_rad", std::atan2(c, s));
      out.set("from_s", e.onset_s[0]);
      break;
    }
    case EffectKind::misalignment:
      out.set("angle_deg", p(0) * 180 / M_PI);
      break;
    default:
      break;
  }
  return out;
}

}  // namespace framewatch
