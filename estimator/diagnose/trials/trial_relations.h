#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Whether two places are one to the equations: a force on the lowest story of a frame is one at
/// its floor, one between a floor and the ground is one at that floor, and a story of a frame is
/// part of the whole frame.
bool same_spot(const EffectPlace& a, const EffectPlace& b);

/// The first trial of every name and place; the others came from other start values.
std::vector<Trial> without_duplicates(const std::vector<Trial>& trials);

/// Whether a trial contradicts the best one: other effects, not the same with one more. An
/// arbitrary force does as well as any law and is no rival.
bool is_rival(const Trial& trial, const Trial& best);

/// The frame in whose stories both effects of a trial are; -1: they are not in one.
int common_frame(const Trial& trial);

}  // namespace framewatch::estimator
