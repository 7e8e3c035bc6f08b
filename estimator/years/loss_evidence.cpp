// SPDX-License-Identifier: MIT
#include "estimator/years/loss_evidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace framewatch::estimator {
namespace {

/// An element wanders by itself, relative, with use, moisture and all that no covariate explains.
/// Three sizes and time constants span what buildings do (tests/estimator/years).
constexpr double kWander[] = {0.0005, 0.0015, 0.0045};
constexpr double kWander_d[] = {3, 10, 30};
constexpr std::size_t kBets = 24;    // followed at once; they lie closer the younger they are
constexpr double kMostSurprise = 4;  // deviations that a single value counts at most
constexpr double kMostLog = 300;     // keeps exp() finite
constexpr double kNever = -1e300;

/// Returns the logarithm of the normal distribution function.
double log_normal(double x) {
  // Mills' ratio for the far tail, where erfc() underflows.
  return x > -30 ? std::log(0.5 * std::erfc(-x / M_SQRT2))
                 : -x * x / 2 - std::log(-x) - 0.5 * std::log(2 * M_PI);
}

}  // namespace

LossEvidence::LossEvidence(const Eigen::VectorXd& prior, double life_d, double least)
    : least_(least), stake_(1 / life_d), log_capital_(kNever) {
  const Eigen::Index n = prior.size() + 1;
  for (const double wander : kWander)
    for (const double wander_d : kWander_d) {
      State state{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
      state.covariance.diagonal().head(n - 1) = prior.array().square();
      state.covariance(n - 1, n - 1) = wander * wander;
      candidates_.push_back({wander, wander_d, std::move(state), {}, {}});
    }
}

void LossEvidence::push(double day, const Weather& weather, double value, double variance,
                        const std::vector<Weather>& suspected) {
  const double days = begun_ ? day - last_day_ : 0;
  begun_ = true;
  last_day_ = day;
  for (Candidate& c : candidates_) {
    update(c, day, days, weather, value, variance);
    for (std::size_t i = 0; i < c.suspicions.size(); ++i)
      (void)step(c, days, suspected[i], value, variance, c.suspicions[i]);
  }
  judge();
  thin();
}

/// One step of Kalman's filter.
LossEvidence::Innovation LossEvidence::step(const Candidate& c, double days, const Weather& weather,
                                            double value, double variance, State& state) {
  const Eigen::Index w = weather.regressors.size();
  const double kept = std::exp(-days / c.wander_d);
  state.mean[w] *= kept;
  state.covariance.row(w) *= kept;
  state.covariance.col(w) *= kept;
  state.covariance(w, w) += c.wander * c.wander * (1 - kept * kept);

  Eigen::VectorXd h(w + 1);
  h << weather.regressors, 1;
  const Eigen::VectorXd gain = state.covariance * h;
  const double coefficients = state.mean.segment(1, w - 1).squaredNorm() +
                              state.covariance.diagonal().segment(1, w - 1).sum();
  const double noise = variance + weather.doubt * weather.doubt * coefficients;
  const double off = value - h.dot(state.mean);
  double total = h.dot(gain) + noise;
  const double surprise = std::abs(off) / std::sqrt(total);
  if (surprise > kMostSurprise) total *= std::pow(surprise / kMostSurprise, 2);
  state.log_likelihood -= 0.5 * (std::log(2 * M_PI * total) + off * off / total);
  state.mean += gain * (off / total);
  state.covariance -= gain * gain.transpose() / total;
  return {h, gain, off, total, kept};
}

/// Takes a value, and what a unit step would have had of it. docs/equations.md (69).
void LossEvidence::update(Candidate& c, double day, double days, const Weather& weather,
                          double value, double variance) {
  const Eigen::Index w = weather.regressors.size();
  c.bets.push_back({day, c.state.log_likelihood, Eigen::VectorXd::Zero(w + 1)});
  const Innovation i = step(c, days, weather, value, variance, c.state);
  for (Bet& bet : c.bets) {
    bet.effect[w] *= i.kept;
    const double seen = 1 - i.h.dot(bet.effect);
    bet.information += seen * seen / i.variance;
    bet.score += seen * i.off / i.variance;
    bet.effect += i.gain * (seen / i.variance);
  }
}

/// Returns what a bet claims: the step's size, and the logarithm of its likelihood over that of the
/// same candidate without it, averaged over the prior of the size.
LossEvidence::Claim LossEvidence::claim_of(const Bet& bet) const {
  const double a = bet.information, b = bet.score, usual = kUsualStep * kUsualStep;
  const double variance = 1 / (1 / usual + a), error = std::sqrt(variance);
  const double beyond = -(b + least_ * a);  // score of what exceeds the least step
  return {b * variance, error,
          -least_ * b - least_ * least_ * a / 2 + std::log(2 * error / kUsualStep) +
              beyond * beyond * variance / 2 + log_normal(beyond * error)};
}

/// Returns the capital of the bet with this index, and keeps the step that it claims if its largest
/// share exceeds `largest`.
double LossEvidence::capital_of(std::size_t bet, double& largest) {
  double best = kNever, capital = 0;
  for (const Candidate& c : candidates_)
    best = std::max(best, c.state.log_likelihood - c.bets[bet].log_likelihood_before);
  for (const Candidate& c : candidates_) {
    const Claim claim = claim_of(c.bets[bet]);
    const double since = c.state.log_likelihood - c.bets[bet].log_likelihood_before;
    const double log = since - best + claim.log_ratio;
    capital += std::exp(std::min(log, kMostLog));
    if (log <= largest) continue;
    largest = log;
    step_ = {c.bets[bet].day, claim.size, claim.std_error};
  }
  return stake_ * capital / static_cast<double>(candidates_.size());
}

void LossEvidence::judge() {
  double capital = settled_, largest = kNever;
  for (std::size_t b = 0; b < candidates_.front().bets.size(); ++b)
    capital += capital_of(b, largest);
  log_capital_ = std::log(capital);
}

/// Stops following the bet whose neighbours in time are closest, measured by its age, but never the
/// one with the largest capital. It keeps its capital, as a player who leaves does.
void LossEvidence::thin() {
  const std::vector<Bet>& bets = candidates_.front().bets;
  if (bets.size() <= kBets) return;
  std::size_t least = 1;
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t b = 1; b + 1 < bets.size(); ++b) {
    if (bets[b].day == step_.day) continue;
    const double gap = (bets[b + 1].day - bets[b - 1].day) / (last_day_ - bets[b].day + 1);
    if (gap < closest) closest = gap, least = b;
  }
  double ignored = std::numeric_limits<double>::infinity();
  settled_ += capital_of(least, ignored);
  for (Candidate& c : candidates_)
    c.bets.erase(c.bets.begin() + static_cast<std::ptrdiff_t>(least));
}

void LossEvidence::suspect() {
  for (Candidate& c : candidates_) c.suspicions.push_back(c.state);
}

void LossEvidence::drop_suspicion(std::size_t index) {
  for (Candidate& c : candidates_)
    c.suspicions.erase(c.suspicions.begin() + static_cast<std::ptrdiff_t>(index));
}

double LossEvidence::suspicion(std::size_t index) const {
  double with = kNever, without = kNever;
  for (const Candidate& c : candidates_) {
    with = std::max(with, c.suspicions[index].log_likelihood);
    without = std::max(without, c.state.log_likelihood);
  }
  return with - without;
}

Eigen::VectorXd LossEvidence::coefficients() const {
  const auto likeliest = std::ranges::max_element(
      candidates_, {}, [](const Candidate& c) { return c.state.log_likelihood; });
  return likeliest->state.mean.head(likeliest->state.mean.size() - 1);
}

void LossEvidence::adopt(std::size_t index) {
  for (Candidate& c : candidates_) {
    c.state = c.suspicions[index];
    c.suspicions.clear();
  }
  clear_bets();
}

void LossEvidence::accept(double std_error) {
  for (Candidate& c : candidates_) {
    c.state.covariance(0, 0) += std_error * std_error;
    for (State& s : c.suspicions) s.covariance(0, 0) += std_error * std_error;
  }
  clear_bets();
}

void LossEvidence::clear_bets() {
  for (Candidate& c : candidates_) c.bets.clear();
  settled_ = 0;
  log_capital_ = kNever;
  step_ = {};
}

}  // namespace framewatch::estimator
