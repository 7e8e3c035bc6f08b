#pragma once

#include <vector>

#include "estimator/diagnose/trials/trial.h"

namespace framewatch::estimator {

/// Returns true if the equations cannot distinguish two places. A force on the lowest story of a
/// frame equals one at its floor, a force between a floor and the ground equals one at that floor,
/// and a story of a frame is part of the whole frame.
bool same_spot(const EffectPlace& a, const EffectPlace& b);

/// Returns the first trial of every name and place. The others had other start values.
std::vector<Trial> without_duplicates(const std::vector<Trial>& trials);

/// Returns true if a trial contradicts the best one: it has other effects, not just one more. An
/// arbitrary force does as well as any law and is not a rival.
bool is_rival(const Trial& trial, const Trial& best);

/// Returns the frame whose stories contain both effects of a trial; -1 if they share no frame.
int common_frame(const Trial& trial);

}  // namespace framewatch::estimator
