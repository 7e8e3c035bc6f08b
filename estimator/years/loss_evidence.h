// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// Weighs the evidence that a quantity has dropped for good, at an unknown day, beside what the
/// weather does to it and what it does by itself. docs/equations.md, years.
///
/// The healthy quantity is y = b . regressors + w + noise: b has a normal prior, so that weather
/// that was never seen widens the error; w wanders slowly and comes back. How much it wanders is
/// not known: kWander candidates run side by side. A drop is a step, of at least `least` and beyond
/// it of half-normal size. Every day begins a bet on a step from that day on. A bet's capital is
/// the mean likelihood of the values since then with a step, over that of the best candidate
/// without one: an element may begin to wander more on any day. The bets' stakes add up to 1 over
/// the life, so the total capital of a healthy quantity ever reaches 1/a with probability a at most
/// (Ville).
class LossEvidence {
 public:
  /// Standard deviation of what a step exceeds the least one by, in the prior.
  static constexpr double kUsualStep = 0.1;

  /// prior: standard deviation of each coefficient. life_d: days over which stakes are spread.
  /// least: smaller steps are no loss.
  LossEvidence(const Eigen::VectorXd& prior, double life_d, double least);

  /// A day's regressors, and how far they may be off (WeatherLags::doubt()).
  struct Weather {
    Eigen::VectorXd regressors;
    double doubt;
  };
  /// Takes a value of a day later than the one before. variance: of its noise. suspected: the
  /// regressors of every suspicion.
  void push(double day, const Weather& weather, double value, double variance,
            const std::vector<Weather>& suspected);

  /// Adds a suspicion, as the last one: the regressors are others from the next value on.
  void suspect();
  void drop_suspicion(std::size_t index);
  /// Returns the logarithm of the likelihood of the values with the regressors of a suspicion over
  /// that with the ones that were read, both of their likeliest candidate.
  double suspicion(std::size_t index) const;
  /// Takes a suspicion as known: goes on with its filters, without the others, and clears all bets.
  void adopt(std::size_t index);
  /// Returns the logarithm of the capital.
  double log_capital() const { return log_capital_; }

  struct Step {
    double day = 0;                  ///< of the first value after it
    double size = 0, std_error = 0;  ///< size < 0
  };
  /// Returns the step of the bet with the largest capital.
  Step step() const { return step_; }
  /// Returns what the regressors do to the value, by regressor; the first one is the level: the
  /// coefficients of the likeliest candidate.
  Eigen::VectorXd coefficients() const;
  /// Takes a step as known: clears all bets and keeps what was learned of the weather. The caller
  /// subtracts the step from later values. std_error: of its size.
  void accept(double std_error);

 private:
  struct Bet {
    double day;
    double log_likelihood_before;       ///< of its candidate, before that day
    Eigen::VectorXd effect;             ///< of a unit step on the state's mean
    double information = 0, score = 0;  ///< of the step's size
  };
  /// The state of a Kalman filter: coefficients, then w.
  struct State {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    double log_likelihood = 0;
  };
  /// One candidate: w with this standard deviation and time constant.
  struct Candidate {
    double wander, wander_d;
    State state;
    std::vector<Bet> bets;  ///< oldest first, alike in all candidates
    std::vector<State> suspicions;
  };
  /// One value's step of a state. h: the row of the regressors and w; kept: share of w that was
  /// left since the value before.
  struct Innovation {
    Eigen::VectorXd h, gain;
    double off, variance, kept;
  };
  static Innovation step(const Candidate& candidate, double days, const Weather& weather,
                         double value, double variance, State& state);
  static void update(Candidate& candidate, double day, double days, const Weather& weather,
                     double value, double variance);
  struct Claim {
    double size, std_error, log_ratio;
  };
  Claim claim_of(const Bet& bet) const;
  double capital_of(std::size_t bet, double& largest);
  void clear_bets();
  void judge();
  void thin();

  std::vector<Candidate> candidates_;
  double least_, stake_;
  double settled_ = 0;  ///< capital of bets that are no longer followed
  double log_capital_, last_day_ = 0;
  bool begun_ = false;
  Step step_;
};

}  // namespace framewatch::estimator
