#pragma once

#include <vector>

#include "estimator/diagnose/trials/trials.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Puts the best of the rejected laws first that may be named in doubt: it takes most of the misfit
/// (is_nearest_law()), at a place of `where` whose sort of force is known, and is of that sort or
/// leaves far less than general functions of the motion do.
/// False when there is none.
bool nearest_law_first(const TrialContext& context, const std::vector<WhereEntry>& where,
                       std::vector<Trial>& rejected);

/// Whether the sort of force that a law's place needs is known and the law's. Contacts and other
/// functions of the deformation are not told apart: a contact that stiffens as it closes is near
/// both. Of a whole frame it is not known: one story's force says nothing of the others'.
bool is_of_the_kind_there(const Trial& law, const std::vector<WhereEntry>& where);

/// Whether the sort of force that a law's place needs is known, and is not the law's. Contacts and
/// other functions of the deformation count as one here too. A force that may be anything is
/// contradicted where the likeliest place is an element whose force follows its motion. left: share
/// of the misfit beyond noise that stays with the law; where that is far less than a general force
/// of the kind leaves, the law is the better evidence.
bool contradicts_the_kind(const Trial& law, const std::vector<WhereEntry>& where, double left = 1);

}  // namespace framewatch::estimator
