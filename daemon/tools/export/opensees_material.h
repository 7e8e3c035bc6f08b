// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// Units in which an element measures: deformation d = stretch * strain, stress = force * f(d).
/// Both are 1 in a link, whose strain is d itself.
struct MaterialScale {
  double stretch = 1, force = 1;
};

/// A uniaxialMaterial of OpenSees without its tag: its type and what follows the tag.
struct OpenSeesMaterial {
  std::string type;
  std::vector<std::string> words;
};

/// Returns the materials that together have the force of an effect on one element. height_m: of the
/// story. Returns an empty vector and sets `why` if OpenSees has no equal material.
std::vector<OpenSeesMaterial> opensees_materials(const estimator::Effect& effect, double height_m,
                                                 const MaterialScale& scale, std::string& why);

/// Returns a spring of `stiffness`, N/m, with a dashpot of `damping`, N*s/m.
OpenSeesMaterial elastic_material(double stiffness, double damping,
                                  const MaterialScale& scale = {});

/// Returns a number in full precision, as both languages read it.
std::string opensees_number(double value);

}  // namespace framewatch::daemon
