// SPDX-License-Identifier: MIT
#include "estimator/gap/channel_check.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

/// Windows of readings that are kept: the base's cause the motion of the last one.
constexpr int kKept = 4;
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
/// Share of the departure's energy that a law of the base may leave. In motion of few modes, a loss
/// of stiffness leaves a fifth beside a delay.
constexpr double kOfInput = 0.15;
constexpr int kLeast_s = 2;  ///< of readings that show a law
/// Seconds after which the law of a doubt is final: the beginning of the fault is still kept.
constexpr int kFinal_s = 12;
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
  expected_.setConstant(kWindow_s * per_second_, columns, kNaN);
  read_.setConstant(kKept * expected_.rows(), columns, kNaN);
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
  const Eigen::Index rows = expected_.rows();
  for (Eigen::Index a = 0; a < read_.cols(); ++a) {
    read_(newest_, a) = instant.read[static_cast<std::size_t>(a)];
    expected_(newest_ % rows, a) = instant.expected[static_cast<std::size_t>(a)];
  }
  const bool looks = ends_second();
  newest_ = (newest_ + 1) % static_cast<int>(read_.rows());
  filled_ = std::min(filled_ + 1, static_cast<int>(read_.rows()));
  if (filled_ < rows || !looks) return news_;
  window_read_ = newest(read_, rows);
  window_expected_ = motion_ = newest(expected_, rows);
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    noise_[a] =
        std::isfinite(noise_variance[a]) ? static_cast<double>(rows) * noise_variance[a] : 0;
    correct(a);
    seen_[a] = look_at(a, noise_[a], instant.start_share);
  }
  const bool quiet =
      std::none_of(seen_.begin(), seen_.end(), [](const Seen& seen) { return seen.departs; });
  if (newest_ % rows == 0) learn(quiet);
  decide(time, find_candidates(instant.base));
  return news_;
}

/// Returns the newest instants of a ring in the order of time.
Eigen::MatrixXd ChannelCheck::newest(const Eigen::MatrixXd& ring, Eigen::Index rows) const {
  Eigen::MatrixXd out(rows, ring.cols());
  const Eigen::Index end = newest_ % ring.rows();
  for (Eigen::Index i = 0; i < rows; ++i)
    out.row(i) = ring.row((end - rows + i + ring.rows()) % ring.rows());
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
  const Eigen::Index last = motion_.rows() - 1;
  const auto own = static_cast<Eigen::Index>(axis);
  for (Eigen::Index i = 0; i <= last; ++i) {
    const Eigen::Index next = std::min(i + 1, last), before = std::max<Eigen::Index>(i - 1, 0);
    double sum = usual.law[0] * (motion_(next, own) - motion_(before, own)) / 2;
    for (std::size_t k = 0; k < usual.from.size(); ++k)
      sum += usual.law[static_cast<Eigen::Index>(k) + 1] * motion_(i, usual.from[k]);
    window_expected_(i, own) = sum;
  }
}

ChannelCheck::Seen ChannelCheck::look_at(std::size_t axis, double noise, double start_share) const {
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
  seen.usual = (usual.share + start_share) * seen.motion + noise;
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

/// Returns the length of the end of the window in which the axes depart: the change of level that
/// explains most of the logarithm of what they leave, by tenths of a second.
Eigen::Index ChannelCheck::rows_since_onset(const std::vector<int>& axes) const {
  const Eigen::Index step = std::max(1, per_second_ / 10), blocks = motion_.rows() / step;
  double usual = 0;
  for (const int a : axes)
    usual += seen_[static_cast<std::size_t>(a)].usual / static_cast<double>(blocks);
  Eigen::VectorXd above(blocks);  // newest first
  for (Eigen::Index k = 0; k < blocks; ++k) {
    const auto rows = Eigen::seqN(motion_.rows() - (k + 1) * step, step);
    above[k] =
        std::log1p((window_read_(rows, axes) - window_expected_(rows, axes)).squaredNorm() / usual);
  }
  above.array() -= above.mean();
  double sum = 0, most = 0;
  Eigen::Index since = blocks * step;
  for (Eigen::Index k = 1; k < blocks; ++k) {
    sum += above[k - 1];
    const double explained = sum * sum / static_cast<double>(k * (blocks - k));
    if (sum > 0 && explained > most) most = explained, since = k * step;
  }
  return since;
}

/// Counts the instants since floors depart.
void ChannelCheck::follow_departure(bool departs, const std::vector<int>& floors) {
  if (!departs)
    departing_ = 0;
  else
    departing_ = std::min(
        departing_ == 0 ? static_cast<int>(rows_since_onset(floors)) : departing_ + per_second_,
        filled_);
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
  const auto motion_along = [&](Direction along) {
    double sum = 0;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      if (const auto column = window_read_.col(static_cast<Eigen::Index>(a));
          axes_[a].story > 0 && axes_[a].horizontal() && along_[a] == along && column.allFinite())
        sum += column.squaredNorm();
    return sum;
  };
  std::vector<Candidate> lost;
  bool moves = false;
  for (std::size_t b = 0; b < axes_.size(); ++b) {
    const auto column = window_read_.col(static_cast<Eigen::Index>(b));
    if (axes_[b].story != 0 || usual_[b].windows < kLearned || !column.allFinite()) continue;
    const double energy = column.squaredNorm();
    const double least = usual_[b].input_share * motion_along(along_[b]);
    moves = moves || (energy > kMoves * least && energy > kAbove * noise_[b]);
    if (energy < kDead * least)
      lost.push_back({static_cast<int>(b),
                      {ChannelFault::only_noise, 0, -1, energy},
                      departure(floors),
                      true});
  }
  return moves ? lost : std::vector<Candidate>{};
}

/// Returns a base channel that repeats a floor's.
std::vector<ChannelCheck::Candidate> ChannelCheck::repeating_input() const {
  const auto rows = Eigen::lastN(kLeast_s * per_second_);
  for (std::size_t b = 0; b < axes_.size(); ++b) {
    if (axes_[b].story != 0) continue;
    const Eigen::VectorXd own = window_read_(rows, static_cast<Eigen::Index>(b));
    for (std::size_t c = 0; c < axes_.size(); ++c) {
      if (axes_[c].story == 0) continue;
      const double left = (own - window_read_(rows, static_cast<Eigen::Index>(c))).squaredNorm();
      if (left < kMatters * kMatters * own.squaredNorm())
        return {{static_cast<int>(b),
                 {ChannelFault::repeats, 0, static_cast<int>(c), left},
                 departure({static_cast<int>(c)}),
                 true}};
    }
  }
  return {};
}

/// Returns the base channel, and the channel exchanged with it if so, whose fault explains how the
/// floors depart: with the reading that it should have had, the model moves as they do. A departure
/// that nothing explains while its beginning is kept has another cause.
std::vector<ChannelCheck::Candidate> ChannelCheck::faulty_input(const std::vector<int>& floors,
                                                                const std::vector<int>& apart,
                                                                BaseResponse& base) const {
  if (departing_ < kLeast_s * per_second_ || departing_ == read_.rows()) return {};
  const Eigen::MatrixXd read = newest(read_, departing_);
  const Eigen::Index rows = std::min(read.rows(), motion_.rows());
  const Eigen::MatrixXd departs = (window_read_ - window_expected_).bottomRows(rows);
  const double all = departs(Eigen::all, floors).squaredNorm();
  ChannelLaw best{ChannelFault::unlike, 0, -1, kOfInput * all};
  Eigen::Index doubted = -1;
  const auto take = [&](Eigen::Index axis, const ChannelLaw& law) {
    if (law.fault != ChannelFault::unlike && law.left < best.left) best = law, doubted = axis;
  };
  for (const Eigen::Index b : base.axes()) {
    const Eigen::VectorXd own = read.col(b);
    if (!own.allFinite()) continue;
    const Eigen::MatrixXd caused = base.of(b, own).bottomRows(rows)(Eigen::all, floors);
    take(b, law_of_input({caused, caused + departs(Eigen::all, floors), rate_hz_}));
    for (const int c : apart) {
      if (along_[static_cast<std::size_t>(c)] != along_[static_cast<std::size_t>(b)]) continue;
      const Eigen::MatrixXd change = base.of(b, read.col(c) - own).bottomRows(rows);
      Eigen::MatrixXd left = departs - change;
      left.col(c) = own.tail(rows) - window_expected_.col(c).tail(rows) - change.col(c);
      take(b, {ChannelFault::exchanged, 0, c, left(Eigen::all, floors).squaredNorm()});
    }
  }
  if (doubted < 0) return {};
  std::vector<Candidate> out{{static_cast<int>(doubted), best, departure(floors), true}};
  if (best.fault == ChannelFault::exchanged) {
    out.push_back({best.other, best, departure({best.other}), true});
    out.back().law.other = static_cast<int>(doubted);
  }
  return out;
}

std::vector<ChannelCheck::Candidate> ChannelCheck::find_candidates(BaseResponse* base) {
  double most = 0;
  std::vector<int> judged, apart;
  bool departs = false;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    if (!seen_[a].judged) continue;
    judged.push_back(static_cast<int>(a));
    departs = departs || seen_[a].departs;
    most = std::max(most, seen_[a].departure);
  }
  follow_departure(departs, judged);
  if (const std::vector<Candidate> lost = lost_inputs(judged); !lost.empty()) return lost;
  if (!departs) return {};
  for (const int a : judged)
    if (seen_[static_cast<std::size_t>(a)].departure > kAlike * most) apart.push_back(a);
  const std::string& group = axes_[static_cast<std::size_t>(apart.front())].group;
  const bool alone = 2 * apart.size() <= judged.size() &&
                     (apart.size() == 1 || std::all_of(apart.begin(), apart.end(), [&](int a) {
                        return !group.empty() && axes_[static_cast<std::size_t>(a)].group == group;
                      }));
  if (!alone) {
    std::vector<Candidate> input;
    if (base != nullptr) input = faulty_input(judged, apart, *base);
    if (input.empty() && !base_doubted()) input = repeating_input();
    if (!input.empty()) return input;
  }
  if (apart.size() > kMostAtOnce || base_doubted()) return {};
  std::vector<Candidate> out;
  for (const int a : apart) {
    const Eigen::Index rows =
        std::max<Eigen::Index>(rows_since_onset({a}), Eigen::Index{kLeast_s} * per_second_);
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

/// Returns true if the motion that the model expects of the floors has a wrong cause.
bool ChannelCheck::base_doubted() const {
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (axes_[a].story == 0 && doubted_[a] != 0) return true;
  return false;
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
  const bool some_judged =
      std::any_of(seen_.begin(), seen_.end(), [](const Seen& seen) { return seen.judged; });
  double others = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (seen_[a].judged && candidate_of(a) == nullptr && doubted_[a] == 0)
      others = std::max(others, departure({static_cast<int>(a)}));
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    Doubt& doubt = doubts_[a];
    const Candidate* const candidate = candidate_of(a);
    const ChannelLaw* law = candidate == nullptr ? nullptr : &candidate->law;
    const bool fits = axes_[a].story == 0 ? departing_ == 0 && some_judged
                                          : seen_[a].motion >= doubt.motion && !seen_[a].departs;
    const bool against = doubt.raised ? law == nullptr && fits : law != nullptr;
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
