// SPDX-License-Identifier: MIT
#include "estimator/gap/channel_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

constexpr int kWindow_s = 5;
constexpr int kLearned = 3;    ///< windows without overlap before an axis is judged: 15 s
constexpr int kForgets = 60;   ///< windows after which older ones fade from the usual law
constexpr double kAbove = 25;  ///< energy of the motion over the noise that makes it judged
/// Least departure in doubt, ln of energies: twice the usual amplitude; and in standard deviations.
const double kDeparts = std::log(4.0);
constexpr double kDeviations = 4;
/// Rms beyond the motion's that matters: the gain of an accelerometer changes by less with weather.
constexpr double kMatters = 0.01;
/// Other channels depart as well if their departure, ln of energies, is more than this share.
constexpr double kAlike = 0.5;
constexpr int kConfirm_s = 3;  ///< consecutive seconds until a doubt is raised
constexpr int kLeast_s = 2;    ///< of readings that show a law
constexpr int kClear_s = 30;   ///< consecutive seconds until it is cleared
/// A base channel that shows this share of the least energy that it ever had beside the floors'.
constexpr double kDead = 0.04;

/// Returns the factors of motion and slope that fit the reading best, from sums of the products of
/// motion, slope and reading.
Eigen::Vector2d fitted(const Eigen::Matrix3d& sums) {
  const double determinant = sums(0, 0) * sums(1, 1) - sums(0, 1) * sums(0, 1);
  return Eigen::Vector2d(sums(1, 1) * sums(0, 2) - sums(0, 1) * sums(1, 2),
                         sums(0, 0) * sums(1, 2) - sums(0, 1) * sums(0, 2)) /
         determinant;
}

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
  const auto columns = static_cast<Eigen::Index>(axes.size());
  read_.setConstant(kWindow_s * per_second_, columns, kNaN);
  expected_ = window_read_ = window_expected_ = read_;
  news_.reserve(axes.size());
}

void ChannelCheck::forget() {
  restart();
  std::fill(usual_.begin(), usual_.end(), Usual{});
  for (Doubt& doubt : doubts_) doubt.seconds = 0;
}

const std::vector<ChannelNews>& ChannelCheck::push(Time time, const std::vector<double>& read,
                                                   const std::vector<double>& expected,
                                                   const std::vector<double>& noise_variance) {
  news_.clear();
  for (Eigen::Index a = 0; a < read_.cols(); ++a) {
    read_(newest_, a) = read[static_cast<std::size_t>(a)];
    expected_(newest_, a) = expected[static_cast<std::size_t>(a)];
  }
  const int rows = static_cast<int>(read_.rows());
  newest_ = (newest_ + 1) % rows;
  filled_ = std::min(filled_ + 1, rows);
  second_ = (second_ + 1) % rows;
  if (filled_ < rows || second_ % per_second_ != 0) return news_;
  time_ = time;
  unroll();
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    noise_[a] = std::isfinite(noise_variance[a]) ? rows * noise_variance[a] : 0;
    correct(a);
    seen_[a] = look_at(a, noise_[a]);
  }
  const bool quiet = std::none_of(seen_.begin(), seen_.end(),
                                  [](const Seen& seen) { return seen.departs; });
  if (second_ == 0 && quiet) learn();
  decide(find_suspects());
  return news_;
}

/// Brings the ring into the order of time.
void ChannelCheck::unroll() {
  const Eigen::Index old = read_.rows() - newest_;
  window_read_.topRows(old) = read_.bottomRows(old);
  window_read_.bottomRows(newest_) = read_.topRows(newest_);
  window_expected_.topRows(old) = expected_.bottomRows(old);
  window_expected_.bottomRows(newest_) = expected_.topRows(newest_);
}

/// Gives the expected motion the gain and the delay that the channel usually has beside the model.
void ChannelCheck::correct(std::size_t axis) {
  const Usual& usual = usual_[axis];
  if (usual.windows < kLearned) return;
  const Eigen::Vector2d law = fitted(usual.sums);
  if (!law.allFinite()) return;
  const auto column = window_expected_.col(static_cast<Eigen::Index>(axis));
  const Eigen::VectorXd motion = column;
  const Eigen::Index last = motion.size() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) {
    const double slope = (motion[std::min(i + 1, last)] - motion[std::max<Eigen::Index>(i - 1, 0)]) / 2;
    window_expected_(i, static_cast<Eigen::Index>(axis)) = law[0] * motion[i] + law[1] * slope;
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
  const double explained = fitted(usual.sums).dot(usual.sums.topRightCorner<2, 1>());
  const double share = std::max(usual.sums(2, 2) - explained, 0.0) / explained;
  seen.usual = share * seen.motion + noise;
  seen.departure = std::log(seen.left / seen.usual);
  const double deviation = std::sqrt(usual.spread / usual.windows);
  seen.departs = seen.departure > std::max(kDeparts, kDeviations * deviation) &&
                 seen.left - seen.usual > kMatters * kMatters * seen.motion;
  return seen;
}

void ChannelCheck::learn() {
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    Usual& usual = usual_[axis];
    const auto a = static_cast<Eigen::Index>(axis);
    if (doubts_[axis].raised || !window_read_.col(a).allFinite()) continue;
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
    // The motion before correct(), in the order of the ring: only sums are taken.
    Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
    const Eigen::Index rows = read_.rows();
    for (Eigen::Index i = 1; i + 1 < rows; ++i) {
      const auto at = [&](Eigen::Index k) { return (newest_ + k) % rows; };
      const Eigen::Vector3d row(expected_(at(i), a),
                                (expected_(at(i + 1), a) - expected_(at(i - 1), a)) / 2,
                                read_(at(i), a));
      sums += row * row.transpose();
    }
    if (!(sums(0, 0) > 0)) continue;
    const double kept = usual.windows < kForgets ? 1 : 1 - 1.0 / kForgets;
    usual.sums = kept * usual.sums + sums / sums(0, 0);  // every window counts alike
    if (seen.judged) usual.spread = kept * usual.spread + seen.departure * seen.departure;
    usual.windows = std::min(usual.windows + 1, kForgets);
  }
}

/// Returns the end of the window, in which the axes depart second by second.
ChannelReadings ChannelCheck::since_onset(const std::vector<int>& axes) const {
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
  const Eigen::Index rows = std::max(seconds, kLeast_s) * per_second_;
  return {window_read_.bottomRows(rows), window_expected_.bottomRows(rows), rate_hz_};
}

std::vector<std::pair<int, ChannelLaw>> ChannelCheck::suspects_of_base(Direction along) const {
  std::vector<int> floors, base;
  double motion = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (along_[a] != along || !axes_[a].horizontal()) continue;
    if (axes_[a].story == 0) {
      if (window_read_.col(static_cast<Eigen::Index>(a)).allFinite())
        base.push_back(static_cast<int>(a));
      continue;
    }
    if (seen_[a].judged) floors.push_back(static_cast<int>(a));
    motion += window_read_.col(static_cast<Eigen::Index>(a)).squaredNorm();
  }
  std::vector<std::pair<int, ChannelLaw>> out;
  for (const int b : base) {
    const auto at = static_cast<std::size_t>(b);
    const double energy = window_read_.col(b).squaredNorm();
    if (usual_[at].windows >= kLearned && energy < kDead * usual_[at].input_share * motion)
      out.emplace_back(b, ChannelLaw{ChannelFault::only_noise, 0, -1, energy});
    for (Eigen::Index other = 0; other < window_read_.cols(); ++other)
      if (other != b && window_read_.col(other).allFinite() &&
          (window_read_.col(b) - window_read_.col(other)).squaredNorm() < kMatters * kMatters * energy)
        out.emplace_back(b, ChannelLaw{ChannelFault::repeats, 0, static_cast<int>(other), 0});
  }
  if (!out.empty() || floors.empty()) return out;
  const ChannelLaw law = law_of_input(since_onset(floors), floors);
  if (law.fault == ChannelFault::unlike) return out;
  for (const int b : base) out.emplace_back(b, law);
  return out;
}

std::vector<std::pair<int, ChannelLaw>> ChannelCheck::find_suspects() const {
  std::vector<std::pair<int, ChannelLaw>> out;
  for (const Direction along : {Direction::x, Direction::y}) {
    double most = 0;
    int judged = 0;
    bool departs = false;
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      if (along_[a] != along || !seen_[a].judged) continue;
      ++judged;
      departs = departs || seen_[a].departs;
      most = std::max(most, seen_[a].departure);
    }
    std::vector<int> apart;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (along_[a] == along && seen_[a].judged && seen_[a].departure > kAlike * most)
        apart.push_back(static_cast<int>(a));
    // Without a judged floor, the base may have lost its motion.
    if (judged == 0 || (departs && 2 * apart.size() > static_cast<std::size_t>(judged))) {
      const auto base = suspects_of_base(along);
      out.insert(out.end(), base.begin(), base.end());
      continue;
    }
    if (!departs) continue;
    for (const int a : apart) {
      const ChannelLaw law = law_of(since_onset({a}), a);
      const bool alone = std::all_of(apart.begin(), apart.end(), [&](int other) {
        const std::string& group = axes_[static_cast<std::size_t>(a)].group;
        return other == a || (!group.empty() && group == axes_[static_cast<std::size_t>(other)].group);
      });
      if (alone || law.fault != ChannelFault::unlike) out.emplace_back(a, law);
    }
  }
  return out;
}

/// Returns the energy of motion that can show that the fault is over.
double ChannelCheck::least_motion(std::size_t axis, const ChannelLaw& law) const {
  const double share = law.fault == ChannelFault::saturated ? 0.5 : 0;
  return std::max(share * seen_[axis].motion, kAbove * noise_[axis]);
}

void ChannelCheck::decide(const std::vector<std::pair<int, ChannelLaw>>& suspects) {
  double others = 0;
  const auto rms = [&](std::size_t a) {
    return std::sqrt(std::max(seen_[a].left - seen_[a].usual, 0.0) / seen_[a].motion);
  };
  const auto law_for = [&](std::size_t a) -> const ChannelLaw* {
    for (const auto& [axis, law] : suspects)
      if (axis == static_cast<int>(a)) return &law;
    return nullptr;
  };
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (seen_[a].judged && law_for(a) == nullptr) others = std::max(others, rms(a));
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Doubt& doubt = doubts_[a];
    const ChannelLaw* law = law_for(a);
    const bool known = axes_[a].story == 0 || seen_[a].motion >= doubt.motion;
    const bool against = doubt.raised ? known && law == nullptr && !seen_[a].departs : law != nullptr;
    doubt.seconds = against ? doubt.seconds + 1 : 0;
    ChannelNews news{static_cast<int>(a), AlarmState::changed, time_, doubt.since, {}, rms(a), others};
    if (doubt.raised) doubt.age = std::min(doubt.age + 1, kWindow_s + 1);
    const bool whole = doubt.age == kWindow_s;  // the fault now fills the window
    const bool named = doubt.law.fault == ChannelFault::unlike && law != nullptr &&
                       law->fault != ChannelFault::unlike;
    if (!doubt.raised && doubt.seconds >= kConfirm_s) {
      doubt = {true, 0, 0, *law, time_ - std::chrono::seconds(kWindow_s), least_motion(a, *law)};
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
