// SPDX-License-Identifier: MIT
#include "estimator/gap/channel_check.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

constexpr int kWindow_s = 5;
constexpr int kLearned = 3;    ///< windows without overlap before an axis is judged: 15 s
constexpr int kForgets = 24;   ///< windows after which older ones fade from the usual law
constexpr double kAbove = 25;  ///< energy of the motion over the noise that makes it judged
/// Least departure in doubt, ln of energies: twice the usual amplitude; and in standard deviations.
const double kDeparts = std::log(4.0);
constexpr double kDeviations = 3;
/// Rms beyond the motion's that matters: the gain of an accelerometer changes by less with weather.
constexpr double kMatters = 0.01;
/// Other channels depart as well if their departure, ln of energies, is more than this share.
constexpr double kAlike = 0.5;
constexpr double kTight = 1.0 / 3;  ///< share of the departure that a law may leave, ln of energies
/// Other channels of its direction that must move as ever for a channel that follows no law. A
/// change of one frame of a few can be near one channel alone.
constexpr int kWitnesses = 3;
/// Consecutive seconds until a doubt is raised: with a law, and without one. A change of the
/// building reaches the other channels within its periods.
constexpr int kConfirm_s = 3, kConfirmUnlike_s = 5;
constexpr int kLeast_s = 2;  ///< of readings that show a law
/// Seconds after which the law of a doubt is final: the motion before the fault has died away.
constexpr int kFinal_s = 30;
constexpr int kClear_s = 30;  ///< consecutive seconds until it is cleared
/// A base channel that shows this share of the least energy that it ever had beside the floors'.
constexpr double kDead = 0.04;
constexpr double kMoves = 0.25;  ///< the same share, above which it moves
/// Motions of the model, of one direction, that correct what the model lacks at a channel.
constexpr std::size_t kMostMotions = 8;
constexpr double kRidge = 1e-6;  ///< of the diagonal: motions of few modes are nearly dependent
/// Channels that may fail together. More would take too long to look at, and are rather a change.
constexpr std::size_t kMostAtOnce = 4;

}  // namespace

ChannelCheck::ChannelCheck(const Structure& structure, const std::vector<SensorAxis>& axes,
                           double rate_hz)
    : axes_(axes),
      rate_hz_(rate_hz),
      per_second_(std::max(1, static_cast<int>(std::lround(rate_hz)))),
      usual_(axes.size()),
      doubts_(axes.size()),
      doubted_(axes.size()),
      seen_(axes.size()),
      noise_(axes.size()) {
  for (const SensorAxis& axis : axes) along_.push_back(direction_of(structure, axis));
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].story == 0 || !axes[a].horizontal()) continue;
    Usual& usual = usual_[a];
    usual.from = {static_cast<Eigen::Index>(a)};
    for (std::size_t b = 0; b < axes.size(); ++b)
      if (b != a && usual.from.size() < kMostMotions && axes[b].story > 0 && axes[b].horizontal() &&
          along_[a] == along_[b])
        usual.from.push_back(static_cast<Eigen::Index>(b));
    usual.forget();
  }
  const auto columns = static_cast<Eigen::Index>(axes.size());
  read_.setConstant(kWindow_s * per_second_, columns, kNaN);
  expected_ = window_read_ = window_expected_ = read_;
  for (const SensorAxis& axis : axes)
    from_input_.push_back(axis.story == 0 && axis.horizontal() ? read_ : Eigen::MatrixXd());
  news_.reserve(axes.size());
}

void ChannelCheck::forget() {
  restart();
  for (Usual& usual : usual_) usual.forget();
  for (Doubt& doubt : doubts_) doubt.seconds = 0;
}

const std::vector<ChannelNews>& ChannelCheck::push(Time time, const ChannelInstant& instant,
                                                   const std::vector<double>& noise_variance) {
  news_.clear();
  for (Eigen::Index a = 0; a < read_.cols(); ++a) {
    read_(newest_, a) = instant.read[static_cast<std::size_t>(a)];
    expected_(newest_, a) = instant.expected[static_cast<std::size_t>(a)];
  }
  for (Eigen::MatrixXd& part : from_input_)
    if (part.size() > 0) part.row(newest_).setConstant(kNaN);
  for (Eigen::Index i = 0; i < instant.from_input.rows(); ++i)
    if (Eigen::MatrixXd& part =
            from_input_[static_cast<std::size_t>(instant.inputs[static_cast<std::size_t>(i)])];
        part.size() > 0)
      part.row(newest_) = instant.from_input.row(i);
  const int rows = static_cast<int>(read_.rows());
  const bool looks = ends_second();
  newest_ = (newest_ + 1) % rows;
  filled_ = std::min(filled_ + 1, rows);
  if (filled_ < rows || !looks) return news_;
  window_read_ = in_order(read_);
  window_expected_ = motion_ = in_order(expected_);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    noise_[a] = std::isfinite(noise_variance[a]) ? rows * noise_variance[a] : 0;
    correct(a);
    seen_[a] = look_at(a, noise_[a]);
  }
  const bool quiet =
      std::none_of(seen_.begin(), seen_.end(), [](const Seen& seen) { return seen.departs; });
  if (newest_ == 0) learn(quiet);
  decide(time, find_candidates());
  return news_;
}

/// Returns a ring of instants in the order of time.
Eigen::MatrixXd ChannelCheck::in_order(const Eigen::MatrixXd& ring) const {
  Eigen::MatrixXd out(ring.rows(), ring.cols());
  out.topRows(ring.rows() - newest_) = ring.bottomRows(ring.rows() - newest_);
  out.bottomRows(newest_) = ring.topRows(newest_);
  return out;
}

void ChannelCheck::Usual::forget() {
  const auto unknowns = static_cast<Eigen::Index>(from.size()) + 1;
  sums.setZero(unknowns + 1, unknowns + 1);
  law.setZero(unknowns);
  waiting = sums;
  waiting_departure = share = mean = spread = input_share = 0;
  windows = 0;
}

/// Corrects the expected motion by what the model usually lacks at this channel.
void ChannelCheck::correct(std::size_t axis) {
  const Usual& usual = usual_[axis];
  if (usual.from.empty() || usual.windows < kLearned) return;
  const Eigen::Index last = read_.rows() - 1;
  const auto own = static_cast<Eigen::Index>(axis);
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index next = std::min(i + 1, last), before = std::max<Eigen::Index>(i - 1, 0);
    double sum = usual.law[0] * (motion_(next, own) - motion_(before, own)) / 2;
    for (std::size_t k = 0; k < usual.from.size(); ++k)
      sum += usual.law[static_cast<Eigen::Index>(k) + 1] * motion_(i, usual.from[k]);
    window_expected_(i, own) = sum;
  }
}

ChannelCheck::Seen ChannelCheck::look_at(std::size_t axis, double noise) const {
  Seen seen;
  const auto a = static_cast<Eigen::Index>(axis);
  const auto read = window_read_.col(a);
  const auto expected = window_expected_.col(a);
  if (!read.allFinite() || !expected.allFinite()) return seen;
  const Usual& usual = usual_[axis];
  seen.motion = expected.squaredNorm();
  seen.left = (read - expected).squaredNorm();
  seen.judged = usual.windows >= kLearned && seen.motion > kAbove * noise;
  if (!seen.judged) return seen;
  seen.usual = usual.share * seen.motion + noise;
  seen.departure = std::log(seen.left / seen.usual) - usual.mean;
  const double deviation = std::sqrt(usual.spread);
  seen.departs = seen.departure > std::max(kDeparts, kDeviations * deviation) &&
                 seen.left - seen.usual > kMatters * kMatters * seen.motion;
  return seen;
}

/// Learns from the window before this one, if no channel departs in this one. So a fault is seen
/// before it can be learned.
void ChannelCheck::learn(bool quiet) {
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    Usual& usual = usual_[axis];
    const auto a = static_cast<Eigen::Index>(axis);
    if (!quiet || doubts_[axis].raised || !window_read_.col(a).allFinite()) {
      usual.waiting.setZero();
      continue;
    }
    if (axes_[axis].story == 0) {
      double floors = 0;
      for (std::size_t f = 0; f < axes_.size(); ++f)
        if (axes_[f].story > 0 && along_[f] == along_[axis]) floors += seen_[f].motion;
      const double energy = window_read_.col(a).squaredNorm();
      if (!(energy > kAbove * noise_[axis]) || !(floors > 0)) continue;
      const double share = energy / floors;
      usual.input_share = usual.windows == 0 ? share : std::min(usual.input_share, share);
      ++usual.windows;
      continue;
    }
    const Seen& seen = seen_[axis];
    if (!(seen.motion > kAbove * noise_[axis])) continue;
    if (!motion_(Eigen::all, usual.from).allFinite()) continue;
    const double weight = 1.0 / std::min(usual.windows + 1, kForgets);
    const auto unknowns = usual.law.size();
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(unknowns + 1, unknowns + 1);
    Eigen::VectorXd row(unknowns + 1);
    for (Eigen::Index i = 1; i + 1 < motion_.rows(); ++i) {
      row[0] = (motion_(i + 1, a) - motion_(i - 1, a)) / 2;
      row.segment(1, unknowns - 1) = motion_(i, usual.from).transpose();
      row[unknowns] = window_read_(i, a);
      sums += row * row.transpose();
    }
    sums /= sums(1, 1);  // every window counts alike
    usual.waiting.swap(sums);
    const double departure =
        std::exchange(usual.waiting_departure, seen.judged ? seen.departure : 0);
    if (sums.isZero(0)) continue;
    usual.sums += weight * (sums - usual.sums);
    Eigen::MatrixXd normal = usual.sums.topLeftCorner(unknowns, unknowns);
    normal.diagonal() *= 1 + kRidge;
    const Eigen::VectorXd right = usual.sums.col(unknowns).head(unknowns);
    usual.law = Ldlt(normal).solve(right);
    if (!usual.law.allFinite()) {
      usual.forget();
      continue;
    }
    usual.share = std::max(usual.sums(unknowns, unknowns) - usual.law.dot(right), 0.0);
    usual.mean += weight * departure;
    usual.spread += weight * (departure * departure - usual.spread);
    usual.windows = std::min(usual.windows + 1, kForgets);
  }
}

/// Returns the length of the end of the window in which the axes depart second by second.
Eigen::Index ChannelCheck::rows_since_onset(const std::vector<int>& axes) const {
  int seconds = 0;
  const auto departs = [&](int second) {
    return std::any_of(axes.begin(), axes.end(), [&](int axis) {
      const auto rows = Eigen::seqN(second * per_second_, per_second_);
      const Seen& seen = seen_[static_cast<std::size_t>(axis)];
      const double motion = window_expected_(rows, axis).squaredNorm();
      const double left = (window_read_(rows, axis) - window_expected_(rows, axis)).squaredNorm();
      const double noise = noise_[static_cast<std::size_t>(axis)] / kWindow_s;
      const double share = (seen.usual - noise_[static_cast<std::size_t>(axis)]) / seen.motion;
      return std::log(left / (share * motion + noise)) > kAlike * seen.departure;
    });
  };
  while (seconds < kWindow_s && departs(kWindow_s - 1 - seconds)) ++seconds;
  return Eigen::Index{std::max(seconds, kLeast_s)} * per_second_;
}

/// Returns the rms of what the axes leave beyond the usual, over that of their motion.
double ChannelCheck::departure(const std::vector<int>& axes) const {
  double beyond = 0, motion = 0;
  for (const int axis : axes) {
    const Seen& seen = seen_[static_cast<std::size_t>(axis)];
    beyond += std::max(seen.left - seen.usual, 0.0);
    motion += seen.motion;
  }
  return motion > 0 ? std::sqrt(beyond / motion) : 0;
}

/// Returns base channels that do not move although the floors and another base channel do. If none
/// of the base moves, the wind may move the floors.
std::vector<ChannelCheck::Candidate> ChannelCheck::lost_inputs(
    const std::vector<int>& floors) const {
  double motion = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (const auto column = window_read_.col(static_cast<Eigen::Index>(a));
        axes_[a].story > 0 && axes_[a].horizontal() && column.allFinite())
      motion += column.squaredNorm();
  std::vector<Candidate> lost;
  bool moves = false;
  for (std::size_t b = 0; b < axes_.size(); ++b) {
    const auto column = window_read_.col(static_cast<Eigen::Index>(b));
    if (axes_[b].story != 0 || usual_[b].windows < kLearned || !column.allFinite()) continue;
    const double energy = column.squaredNorm(), least = usual_[b].input_share * motion;
    moves = moves || (energy > kMoves * least && energy > kAbove * noise_[b]);
    if (energy < kDead * least)
      lost.push_back({static_cast<int>(b),
                      {ChannelFault::only_noise, 0, -1, energy},
                      departure(floors),
                      true});
  }
  return moves ? lost : std::vector<Candidate>{};
}

/// Returns the base channel that repeats a floor's, or whose fault explains how the floors depart.
std::vector<ChannelCheck::Candidate> ChannelCheck::faulty_input(
    const std::vector<int>& floors) const {
  const Eigen::Index rows = rows_since_onset(floors);
  const Eigen::MatrixXd read = window_read_.bottomRows(rows)(Eigen::all, floors);
  const Eigen::MatrixXd expected = window_expected_.bottomRows(rows)(Eigen::all, floors);
  std::vector<Candidate> out;
  double least = kExplained * (read - expected).squaredNorm();
  for (std::size_t b = 0; b < axes_.size(); ++b) {
    if (from_input_[b].size() == 0) continue;
    const auto column = window_read_.col(static_cast<Eigen::Index>(b)).tail(rows);
    for (const int other : floors) {
      const double left = (column - window_read_.col(other).tail(rows)).squaredNorm();
      if (left < kMatters * kMatters * column.squaredNorm())
        return {{static_cast<int>(b),
                 {ChannelFault::repeats, 0, other, left},
                 departure(floors),
                 true}};
    }
    const Eigen::MatrixXd part = in_order(from_input_[b]).bottomRows(rows)(Eigen::all, floors);
    if (!part.allFinite()) continue;
    const ChannelLaw law = law_of_input({read - expected + part, part, rate_hz_});
    if (law.fault == ChannelFault::unlike || !(law.left < least)) continue;
    least = law.left;
    out = {{static_cast<int>(b), law, departure(floors), true}};
  }
  return out;
}

std::vector<ChannelCheck::Candidate> ChannelCheck::find_candidates() const {
  double most = 0;
  std::vector<int> judged, apart;
  bool departs = false;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (!seen_[a].judged) continue;
    judged.push_back(static_cast<int>(a));
    departs = departs || seen_[a].departs;
    most = std::max(most, seen_[a].departure);
  }
  if (const std::vector<Candidate> lost = lost_inputs(judged); !lost.empty()) return lost;
  if (!departs) return {};
  for (const int a : judged)
    if (seen_[static_cast<std::size_t>(a)].departure > kAlike * most) apart.push_back(a);
  const std::string& group = axes_[static_cast<std::size_t>(apart.front())].group;
  const bool alone = 2 * apart.size() <= judged.size() &&
                     (apart.size() == 1 || std::all_of(apart.begin(), apart.end(), [&](int a) {
                        return !group.empty() && axes_[static_cast<std::size_t>(a)].group == group;
                      }));
  if (!alone)
    if (const std::vector<Candidate> base = faulty_input(judged); !base.empty()) return base;
  if (apart.size() > kMostAtOnce) return {};
  std::vector<Candidate> out;
  for (const int a : apart) {
    const Eigen::Index rows = rows_since_onset({a});
    const Eigen::MatrixXd read = window_read_.bottomRows(rows);
    const Eigen::MatrixXd expected = window_expected_.bottomRows(rows);
    const ChannelLaw law = law_of({read, expected, rate_hz_}, a);
    // A change of the building is like a delay or a gain too, but leaves more than these do.
    const Seen& seen = seen_[static_cast<std::size_t>(a)];
    const double usual = seen.usual * expected.col(a).squaredNorm() / seen.motion;
    const double limit = std::max(kDeparts, kTight * seen.departure);
    const bool tight = law.fault == ChannelFault::only_noise ||
                       (law.fault != ChannelFault::unlike && std::log(law.left / usual) < limit);
    if (!tight && !(alone && witnesses(a) >= kWitnesses)) return {};
    out.push_back({a, law, departure({a}), tight});
  }
  return out;
}

/// Returns the number of other channels of its direction that move as ever.
int ChannelCheck::witnesses(int axis) const {
  int count = 0;
  for (std::size_t b = 0; b < axes_.size(); ++b)
    if (along_[b] == along_[static_cast<std::size_t>(axis)] && seen_[b].judged &&
        seen_[b].departure <= kAlike * seen_[static_cast<std::size_t>(axis)].departure)
      ++count;
  return count;
}

/// Returns the energy of motion that can show that the fault is over.
double ChannelCheck::least_motion(std::size_t axis, const ChannelLaw& law) const {
  const double share = law.fault == ChannelFault::saturated ? 0.5 : 0;
  return std::max(share * seen_[axis].motion, kAbove * noise_[axis]);
}

void ChannelCheck::decide(Time time, const std::vector<Candidate>& candidates) {
  const auto candidate_of = [&](std::size_t a) -> const Candidate* {
    for (const Candidate& s : candidates)
      if (s.axis == static_cast<int>(a)) return &s;
    return nullptr;
  };
  double others = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (seen_[a].judged && candidate_of(a) == nullptr && doubted_[a] == 0)
      others = std::max(others, departure({static_cast<int>(a)}));
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Doubt& doubt = doubts_[a];
    const Candidate* const candidate = candidate_of(a);
    const ChannelLaw* law = candidate == nullptr ? nullptr : &candidate->law;
    const bool known = axes_[a].story == 0 || seen_[a].motion >= doubt.motion;
    const bool against =
        doubt.raised ? known && law == nullptr && !seen_[a].departs : law != nullptr;
    doubt.seconds = against ? doubt.seconds + 1 : 0;
    ChannelNews news{static_cast<int>(a), AlarmState::changed, time, doubt.since, {}, 0, others};
    if (candidate != nullptr) news.departure = candidate->departure;
    if (doubt.raised) doubt.age = std::min(doubt.age + 1, kFinal_s + 1);
    const bool whole = doubt.age == kWindow_s || doubt.age == kFinal_s;
    const bool named = doubt.law.fault == ChannelFault::unlike && law != nullptr &&
                       law->fault != ChannelFault::unlike;
    if (!doubt.raised && candidate != nullptr &&
        doubt.seconds >= (candidate->sure ? kConfirm_s : kConfirmUnlike_s)) {
      doubt = {true, 0, 0, *law, time - std::chrono::seconds(kWindow_s), least_motion(a, *law)};
      news.state = AlarmState::raised;
      news.since = doubt.since;
    } else if (doubt.raised && doubt.seconds >= kClear_s) {
      doubt.raised = false, doubt.seconds = 0;
      news.state = AlarmState::cleared;
    } else if (doubt.raised && law != nullptr && (whole || named)) {
      doubt.law = *law;
      doubt.motion = least_motion(a, *law);
    } else {
      continue;
    }
    doubted_[a] = doubt.raised;
    news.law = doubt.law;
    news_.push_back(news);
  }
}

}  // namespace framewatch::estimator
