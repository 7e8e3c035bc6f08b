#pragma once

#include <vector>

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::friction. Parameters after v0 are optional. `presliding`
/// is the deformation at which a spring of constant stiffness fc / presliding would reach fc; 0
/// means no presliding. With presliding the force is fc z,
///
///   z' = (v - |v| z / g(|v|)) / presliding, g(v) = (1 + s exp(-(v/vs)^2)) tanh(v/v0)
///
/// which approaches z = g(v) in steady motion. Source: Canudas de Wit, Olsson, Astrom and
/// Lischinsky, IEEE Trans. Automatic Control 40 (1995).
struct FrictionIndex {
  enum : std::size_t { fc, v0, static_ratio, stribeck, presliding };
};

/// Returns the steady force over fc at the velocity v, with the sign of v.
double steady_friction(const std::vector<double>& p, double v);
/// Returns z after a step of step_s from (z, v) to the velocity v_now.
double sliding_z(const std::vector<double>& p, double z, double v, double v_now, double step_s);

}  // namespace framewatch::estimator
