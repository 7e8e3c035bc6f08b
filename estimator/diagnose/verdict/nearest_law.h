// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/trials/trials.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

/// Moves the best rejected law that may be named with low confidence to the front. The law must
/// explain most of the misfit (is_nearest_law()) at a place of `where` with a known kind of force.
/// It must be of that kind or leave far less than general functions of the motion. Returns false if
/// there is no such law.
bool nearest_law_first(const TrialContext& context, const std::vector<WhereEntry>& where,
                       std::vector<Trial>& rejected);

/// Returns true if the kind of force at a law's place is known and is the law's. Contacts and other
/// functions of the deformation count as one kind, because a contact that stiffens as it closes
/// resembles both. Unknown for a whole frame: the force of one story says nothing about the others.
bool is_of_the_kind_there(const SearchSettings& settings, const Trial& law,
                          const std::vector<WhereEntry>& where);

/// Returns true if the kind of force at a law's place is known and is not the law's. Contacts and
/// other functions of the deformation count as one kind. An arbitrary force is contradicted if the
/// likeliest place is an element whose force follows its motion. left: share of the misfit beyond
/// noise that the law leaves. If that is far less than a general force of the kind leaves, the law
/// is the better evidence.
bool contradicts_the_kind(const SearchSettings& settings, const Trial& law,
                          const std::vector<WhereEntry>& where, double left = 1);

}  // namespace framewatch::estimator
