#pragma once

#include <vector>

namespace framewatch::estimator {

/// Indices of the parameters of LawForm::friction; those after v0 may be missing. `presliding` is
/// the deformation at which a spring of the constant slope fc / presliding would reach fc: 0 is
/// none. With it the force is fc z,
///
///   z' = (v - |v| z / g(|v|)) / presliding, g(v) = (1 + s exp(-(v/vs)^2)) tanh(v/v0)
///
/// which ends at z = g(v) in steady motion. Source: Canudas de Wit, Olsson, Astrom and Lischinsky,
/// IEEE Trans. Automatic Control 40 (1995).
struct FrictionIndex {
  enum : std::size_t { fc, v0, static_ratio, stribeck, presliding };
};

/// Steady force over fc at the velocity v, with its sign.
double steady_friction(const std::vector<double>& p, double v);
/// z after a step of step_s from (z, v) to v_now.
double sliding_z(const std::vector<double>& p, double z, double v, double v_now, double step_s);

}  // namespace framewatch::estimator
