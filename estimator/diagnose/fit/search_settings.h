// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <variant>

#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// The numbers that decide what `diagnose` tries and what it believes. search_settings() lists them
/// with their ranges; docs/lab/sensitivity.md shows what each of them changes.
///
/// A *cost* is half the sum of squares of the whitened equations and of the priors, that is a
/// negative log-likelihood. A *ratio* is a misfit over its expectation under noise alone. A *share*
/// is of the misfit beyond noise. A *gap* is the NRMSE of the free run.
struct SearchSettings {
  // Evidence.
  double significant = 4;  ///< standard deviations of the misfit under noise
  double min_gain = 50;    ///< smallest fall of the cost that justifies an effect
  double same_cost = 8;    ///< difference of costs that does not decide between names
  double doubt_cost = 20;  ///< difference of costs that reduces the doubt by the factor e
  double surest = 0.999;   ///< largest confidence: a law that is not tried may be the right one
  double implausible_masses = 15;  ///< prior cost of the masses, above its expectation
  double mass_std = 2;             ///< standard deviations of a frame's mass that are tolerated

  // Shares of the misfit beyond noise that a law explains.
  double sharp = 0.995;        ///< leaves nothing: the law is not refined or called in question
  double explains = 0.97;      ///< is named
  double explains_most = 0.9;  ///< is named if the rest is within chance
  double explains_much = 0.8;  ///< is named as the nearest one, or rivals the best
  double promises = 0.4;       ///< is worth refining, or a search for a second effect
  double pair_leaves = 0.4;    ///< of the rest of one place: the most that two places may leave
  double kind_leaves = 0.1;    ///< of the rest of its kind: a law that leaves less needs no kind
  double separate = 0.25;      ///< left if each record is fitted alone: records of two states

  // Ratios.
  double to_explain = 1.05;        ///< below it there is nothing to explain
  double adequate = 1.25;          ///< below it a model is adequate
  double near_noise = kNearNoise;  ///< below it the rest is within reach of noise
  double one_place = 1.6;          ///< above it one place does not suffice
  double noise_at_place = 3;       ///< above it a place does not show the noise
  double far_off = 10;             ///< above it the channels' labels are doubted
  double most_of_noise = 60;       ///< above it no color of the noise explains the rest
  double as_likely = 2;            ///< times the excess of the best place: places to be compared
  double place_margin = 0.1;       ///< added to that: a free place is found only so precisely
  double clearer = 0.7;            ///< of the excess: a place of a search that replaces another

  // The color of the noise.
  double noise_spread = 2;           ///< largest spread_of() of noise
  double perhaps_noise_spread = 10;  ///< that spread before the model is fitted to the color
  double same_corner = 0.15;         ///< relative difference of corner frequencies
  double outlier_std = 3;            ///< standard deviations of a cell of noise
  double cells_of_noise = 0.6;       ///< smallest share of cells that are noise

  // Gaps, one over another.
  double same_gap = 0.02;      ///< relative difference: sensors do not tell such gaps apart
  double clearly_less = 0.75;  ///< a rough fit decides
  double leads = 0.9;          ///< a law that leads, or the first of several causes
  double pays = 0.95;          ///< one more cause: a tenth of the misfit's power
  double damping_pays = 0.97;  ///< modal damping instead of dashpots only
  double nearly_best = 1.1;    ///< does nearly as well as the best
  double undetermined = 1.5;   ///< training records alone over all records
  double at_floor = 1.15;      ///< over the gap's floor: nothing is left
  double near_floor = 2.5;     ///< over its floor: the effects, or the linear model, explain it

  // Trials that are given up.
  double hopeless = 4;            ///< times the least cost, or the excess beyond chance
  double behind = 2;              ///< significant falls of the cost: no rival
  double leaves_little = 0.3;     ///< of the cost: something was found
  double useless = 0.9;           ///< of the cost: explains nothing
  double promised_by_step = 0.5;  ///< of the needed fall or of chance, promised by one step

  // Kinds of a force at a place.
  double kind_follows = 0.5;     ///< share below which no kind explains the force
  double simpler_kind = 0.93;    ///< of the best share: a simpler kind does
  double beyond_linear = 1.3;    ///< ratio of a linear element: below it nothing else is there
  double as_impact = 0.7;        ///< of the powers' rest: a clearance explains it
  double follows = 0.3;          ///< share of a force that laws explain: it follows the motion
  double follows_at_rest = 0.6;  ///< that share if the force acts at rest, too
  double some_at_rest = 0.25;    ///< power at rest over the mean: the force may be external
  double much_at_rest = 0.5;     ///< that power from which follows_at_rest is asked
  double at_rest = 0.15;         ///< share of the seconds that count as rest
  double stands_out = 3;         ///< power of a force over its noise

  // Names of fitted laws.
  double quadratic = 2.45;       ///< exponent of the deformation below which a spring is quadratic
  double no_power = 0.25;        ///< exponent of the rate below which a damper is friction
  double rigid = 0.02;           ///< yield over largest deformation below which it is friction
  double slips = 1.3;            ///< stiffness at yielding over that at zero force: it pinches
  double sudden = 0.06;          ///< of the record: a change of stiffness is a drop
  double dissipates = 0.15;      ///< loop over its box, below which pinching is elastic
  double narrowest_slip = 0.08;  ///< of a slip zone, in yield deformations
  double dulled = 0.4;           ///< damping ratio above which an oscillator does not resonate

  // Starts.
  double small_start = 0.1;  ///< of an effect's size, or of the design

  // How many are tried.
  std::size_t places = 5;             ///< places that are iterated, or whose laws are fitted
  std::size_t of_one_sort = 3;        ///< places of one sort among them
  std::size_t of_the_building = 2;    ///< places of the whole building or a floor among them
  std::size_t as_likely_places = 16;  ///< further places that are as likely
  std::size_t pair_leaders = 6;       ///< places that are paired with every other
  std::size_t laws = 6;               ///< laws of a place, labels, sets of causes that are fitted
  std::size_t finalists = 3;          ///< of a place, that get free runs; rivals; causes
  std::size_t laws_of_pair = 2;       ///< laws of each place of a pair
  std::size_t causes = 9;             ///< laws among which several causes are searched for
  std::size_t labels = 24;            ///< labels, or axes in pairs
  std::size_t linear_effects = 8;     ///< linear effects in place of implausible masses
  std::size_t dampers = 4;            ///< dampers in place of modal damping

  // Steps of a fit.
  int first_steps = 3;     ///< before candidates are compared
  int rough_steps = 4;     ///< of a start among several
  int steps = 6;           ///< of a model that is near its end, in each of two ways
  int long_steps = 8;      ///< of a model after a change
  int longest_steps = 15;  ///< of a model that starts far off
};

/// One number of SearchSettings and the range outside which it makes no sense.
struct SearchSetting {
  const char* name;
  std::variant<double SearchSettings::*, int SearchSettings::*, std::size_t SearchSettings::*>
      member;
  double low, high;

  double of(const SearchSettings& settings) const;
  /// Sets the number to the nearest value in its range.
  void set(SearchSettings& settings, double value) const;
};

/// Returns every number of SearchSettings, in its order.
std::span<const SearchSetting> search_settings();

}  // namespace framewatch::estimator
