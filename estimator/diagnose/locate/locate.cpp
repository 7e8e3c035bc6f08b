// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/locate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include "estimator/diagnose/fit/noise_corner.h"
#include "estimator/diagnose/fit/softened_fit.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr int kTimesBeside = 3;           ///< that places are located beside a color
constexpr int kTimesCells = 10;           ///< that cells are selected
constexpr std::size_t kMaxOfPairs = 150;  ///< places of a large building, best first

/// Returns the residual with arbitrary signals at a place, in cells.
std::vector<NoiseCell> cells_at(const Fitter& fitter, const Localisation& place) {
  std::vector<NoiseCell> out;
  const std::vector<Whitened> systems =
      fitter.systems(place.model, place.motion, Forcing::measured);
  for (std::size_t r = 0; r < systems.size(); ++r) {
    const Whitened& system = systems[r];
    const RecordSegment& segment = fitter.segments()[r];
    const Index n = system.operation.equations();
    for (Index from = 0; from + kBinsOfCell <= system.bins(); from += kBinsOfCell) {
      double power = 0, numbers = 0;
      for (Index b = from; b < from + kBinsOfCell; ++b) {
        VectorXcd rest(n);
        rest.real() = system.rest.segment(2 * n * b, n);
        rest.imag() = system.rest.segment(2 * n * b + n, n);
        const MatrixXcd basis = candidate_basis(system, b, place.candidate_places);
        power += rest.squaredNorm() - (basis.adjoint() * rest).squaredNorm();
        numbers += static_cast<double>(n - basis.cols());
      }
      const double hz = segment.w[from + kBinsOfCell / 2] / (2 * M_PI);
      out.push_back({hz, segment.corner_hz, power / numbers, numbers});
    }
  }
  return out;
}

/// Returns the corner frequency of most of the cells. Removes the other cells from `cells`.
double corner_of_most(const SearchSettings& settings, std::vector<NoiseCell>& cells) {
  const std::vector<NoiseCell> all = cells;
  double corner_hz = likeliest_corner_hz(cells);
  for (int i = 0; i < kTimesCells; ++i) {
    const auto excess = [&](const NoiseCell& c) {
      return (c.level / c.expected(corner_hz) - 1) * std::sqrt(c.numbers);
    };
    std::vector<double> sorted;
    for (const NoiseCell& c : all) sorted.push_back(excess(c));
    std::sort(sorted.begin(), sorted.end());
    const auto most =
        static_cast<std::size_t>(settings.cells_of_noise * static_cast<double>(sorted.size()));
    const double limit = std::max(settings.outlier_std, sorted[most]);
    cells.clear();
    std::copy_if(all.begin(), all.end(), std::back_inserter(cells),
                 [&](const NoiseCell& c) { return excess(c) <= limit; });
    const double next_hz = likeliest_corner_hz(cells);
    if (next_hz == corner_hz) break;
    corner_hz = next_hz;
  }
  return corner_hz;
}

void sort_by_ratio(std::vector<Localisation>& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Localisation& a, const Localisation& b) { return a.ratio < b.ratio; });
}

/// Returns the ratio above which a place is too far from the best to be tried.
double margin_of(const SearchSettings& settings, const Localisation& best) {
  const double excess = std::max(best.ratio, settings.to_explain) - 1;
  return 1 + settings.as_likely * excess + settings.place_margin;
}

/// Returns that ratio for places that have not converged.
double wide_margin_of(const SearchSettings& settings, const Localisation& best) {
  return 1 + settings.as_likely * (margin_of(settings, best) - 1);
}

/// Iterates localizations from their first step. Stops those whose ratio after a few steps exceeds
/// limit_of(best).
std::vector<Localisation> iterated(const Fitter& fitter, const FitResult& now,
                                   const std::vector<const Localisation*>& starts, int steps,
                                   const std::function<double(const Localisation&)>& limit_of,
                                   const Parallel& parallel) {
  std::vector<Localisation> out(starts.size());
  run_all(parallel, static_cast<int>(starts.size()), [&](int i) {
    const Localisation& from = *starts[static_cast<std::size_t>(i)];
    out[static_cast<std::size_t>(i)] =
        localise(fitter, from.model.theta.size() > 0 ? from.model : now.model, {},
                 from.candidate_places, fitter.settings().first_steps);
  });
  std::erase_if(out, [](const Localisation& l) { return l.model.theta.size() == 0; });
  if (out.empty()) return out;
  sort_by_ratio(out);
  const double limit = limit_of(out.front());
  run_all(parallel, static_cast<int>(out.size()), [&](int i) {
    Localisation& one = out[static_cast<std::size_t>(i)];
    // A large error of a reading converges slowly, and is considered before physical effects.
    const bool axis = one.candidate_places.front().kind == CandidatePlace::Kind::axis;
    if (one.converged || (one.ratio > limit && !axis)) return;
    const Localisation on = localise(fitter, one.model, one.motion, one.candidate_places,
                                     std::max(0, steps - fitter.settings().first_steps));
    if (on.misfit < one.misfit) one = on;
  });
  sort_by_ratio(out);
  return out;
}

std::vector<CandidatePlace> of_one_direction(const std::vector<Localisation>& once) {
  std::vector<CandidatePlace> out;
  for (const Localisation& l : once)
    if (l.candidate_places.front().size() == 1) out.push_back(l.candidate_places.front());
  return out;
}

/// Returns localizations of all lists after one step, best first; empty if the model cannot be
/// computed.
std::vector<Localisation> one_step(const Fitter& fitter, const FitResult& now,
                                   const std::vector<std::vector<CandidatePlace>>& lists,
                                   const Parallel& parallel) {
  std::vector<Whitened> systems = fitter.systems(now.model, now.motion, Forcing::measured);
  if (systems.empty()) return {};
  const Linearised at = fitter.linearise(now.model, std::move(systems));
  std::vector<Localisation> out = localise_once(fitter, at, now.model, lists, parallel);
  sort_by_ratio(out);
  return out;
}

/// Returns the best lists after one step, iterated, best first.
std::vector<Localisation> best_lists(const Fitter& fitter, const FitResult& now,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const Parallel& parallel) {
  const std::vector<Localisation> all = one_step(fitter, now, lists, parallel);
  const SearchSettings& settings = fitter.settings();
  std::vector<const Localisation*> starts;
  for (std::size_t i = 0; i < std::min(settings.finalists, all.size()); ++i)
    starts.push_back(&all[i]);
  return iterated(
      fitter, now, starts, settings.steps,
      [&](const Localisation& best) { return wide_margin_of(settings, best); }, parallel);
}

/// Returns true if the likeliest place explains far less than chance. Near the noise, one step
/// suffices to know.
bool leaves_nothing(const Fitter& fitter, const FitResult& now,
                    const std::vector<Localisation>& once) {
  if (once.empty()) return true;
  const double ratio = now.total_misfit() / fitter.expected(now.model);
  const double excess =
      ratio - std::clamp(once.front().ratio, fitter.settings().promised_by_step, 1.0);
  return ratio < fitter.settings().near_noise &&
         excess < fitter.settings().promised_by_step * chance_of(fitter, now.model);
}

bool is_global(const CandidatePlace& s) {
  return s.kind == CandidatePlace::Kind::rocking || s.kind == CandidatePlace::Kind::floor;
}

}  // namespace

double chance_of(const Fitter& fitter, const Model& model) {
  return fitter.settings().significant / std::sqrt(fitter.expected(model));
}

Located locate(const Fitter& fitter, const FitResult& now, const Parallel& parallel) {
  const SearchSettings& settings = fitter.settings();
  Located out;
  std::vector<std::vector<CandidatePlace>> lists;
  for (const CandidatePlace& s : candidate_places_of(fitter.plant(), now.model))
    lists.push_back({s});
  // The many elements of a large building make up for an effect that is missing.
  const FitResult start = fitter.plant().is_large() ? softened_fit(fitter, now) : now;
  out.once = one_step(fitter, start, lists, parallel);
  std::vector<const Localisation*> starts;
  std::size_t global = 0, single = 0;
  const bool nothing = leaves_nothing(fitter, now, out.once);
  for (std::size_t i = 0; i < out.once.size(); ++i) {
    const CandidatePlace& place = out.once[i].candidate_places.front();
    // In a large building, both directions of a mass rank above either direction alone.
    const bool alone =
        fitter.plant().is_large() && place.size() == 1 && single < settings.of_one_sort;
    const bool more = (is_global(place) && global < settings.of_the_building) || alone;
    if (i >= settings.places && !more) continue;
    if (nothing && i > 0) break;
    global += is_global(place);
    single += place.size() == 1;
    starts.push_back(&out.once[i]);
  }
  out.places = iterated(
      fitter, start, starts, settings.long_steps,
      [&](const Localisation& best) { return wide_margin_of(settings, best); }, parallel);
  return out;
}

std::vector<Localisation> locate_pairs(const Fitter& fitter, const FitResult& now,
                                       const std::vector<Localisation>& once,
                                       const Parallel& parallel) {
  const SearchSettings& settings = fitter.settings();
  std::vector<CandidatePlace> all = of_one_direction(once);
  if (fitter.plant().is_large() && all.size() > kMaxOfPairs) all.resize(kMaxOfPairs);
  std::vector<std::vector<CandidatePlace>> lists;
  // Two exchanged axes rank high among the axes, each by itself.
  std::vector<char> leading_axis(all.size(), 0);
  std::size_t axes = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].kind == CandidatePlace::Kind::axis) leading_axis[i] = axes++ < settings.labels;
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (i < settings.pair_leaders || (leading_axis[i] && leading_axis[j]))
        lists.push_back({all[i], all[j]});
  return best_lists(fitter, now, lists, parallel);
}

std::vector<Localisation> locate_beside(const Fitter& fitter, const FitResult& now,
                                        const std::vector<Localisation>& once,
                                        const CandidatePlace& known, const Parallel& parallel) {
  std::vector<std::vector<CandidatePlace>> lists;
  for (const CandidatePlace& s : of_one_direction(once))
    if (!(s.place == known.place)) lists.push_back({s, known});
  return best_lists(fitter, now, lists, parallel);
}

std::vector<Localisation> as_likely(const Fitter& fitter, const FitResult& now,
                                    const Located& located, const Parallel& parallel) {
  if (located.once.empty() || located.places.empty()) return {};
  const double chance = chance_of(fitter, now.model);
  const double most = located.once.front().ratio + chance;
  std::vector<const Localisation*> starts;
  for (const Localisation& l : located.once) {
    const CandidatePlace& s = l.candidate_places.front();
    const bool seen = std::any_of(
        located.places.begin(), located.places.end(),
        [&](const Localisation& place) { return place.candidate_places.front().place == s.place; });
    if (l.ratio > most || starts.size() >= fitter.settings().as_likely_places) break;
    if (s.kind != CandidatePlace::Kind::element && !seen) starts.push_back(&l);
  }
  const double limit = located.places.front().ratio + chance;
  std::vector<Localisation> out = iterated(
      fitter, now, starts, fitter.settings().long_steps,
      [&](const Localisation&) { return limit + chance; }, parallel);
  std::erase_if(out, [&](const Localisation& l) { return l.ratio > limit; });
  return out;
}

std::vector<Localisation> contenders(const SearchSettings& settings,
                                     const std::vector<Localisation>& places) {
  std::vector<Localisation> out;
  std::map<CandidatePlace::Kind, int> of_kind;
  if (places.empty()) return out;
  // Two directions of a mass explain more of an unexplained misfit than the one direction where the
  // cause may act.
  const auto single = std::find_if(places.begin(), places.end(), [](const Localisation& place) {
    return place.candidate_places.front().size() == 1;
  });
  const bool apart = places.front().ratio > settings.near_noise && single != places.end();
  const double wide = wide_margin_of(settings, places.front());
  for (const Localisation& place : places) {
    const bool alone = apart && place.candidate_places.front().size() == 1;
    const double limit = margin_of(settings, alone ? *single : places.front());
    // Bending frames are located by a moment at the base, which explains only part of them.
    const bool moment = place.candidate_places.front().kind == CandidatePlace::Kind::rocking;
    if (place.ratio > (moment ? wide : limit)) continue;
    const bool another_kind = of_kind[place.candidate_places.front().kind]++ == 0;
    const bool worth =
        out.size() < settings.of_one_sort || (another_kind && out.size() < settings.places);
    if (worth || moment) out.push_back(place);
  }
  return out;
}

bool set_noise_corner_at(const Fitter& fitter, std::vector<RecordSegment>& segments,
                         const Localisation& place) {
  const double before_hz = segments.front().corner_hz;
  Localisation now = place;
  double spread = 0;
  for (int i = 0; i <= kTimesBeside; ++i) {
    std::vector<NoiseCell> cells = cells_at(fitter, now);
    if (cells.empty() || (i == 0 && spread_of(cells, 0) < fitter.settings().noise_spread)) break;
    const double corner_hz = corner_of_most(fitter.settings(), cells);
    spread = spread_of(cells, corner_hz);
    if (i == kTimesBeside || corner_hz == 0) break;
    if (std::abs(corner_hz - segments.front().corner_hz) <
        fitter.settings().same_corner * corner_hz)
      break;
    set_corner(corner_hz, segments);
    now = localise(fitter, now.model, now.motion, now.candidate_places, fitter.settings().steps);
  }
  if (spread > fitter.settings().noise_spread) set_corner(before_hz, segments);
  return segments.front().corner_hz != before_hz;
}

}  // namespace framewatch::estimator
