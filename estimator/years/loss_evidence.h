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

  /// Takes a value of a day later than the one before. variance: of its noise. regressors_doubt:
  /// see WeatherLags::doubt(). errors: a column for each suspicion, by how much the regressors are
  /// wrong today if it is right.
  void push(double day, const Eigen::VectorXd& regressors, double regressors_doubt, double value,
            double variance, const Eigen::MatrixXd& errors);

  /// The logarithm of the likelihood of values with an effect of some size, over that without it,
  /// is score * size - information * size^2 / 2.
  struct Likelihood {
    double information = 0, score = 0;
  };
  /// Adds a suspicion that the regressors are wrong from the next day on, as the last one.
  void suspect();
  void drop_suspicion(std::size_t index);
  /// Returns what the values say of a suspicion: of a factor of its errors, for the candidate that
  /// is likeliest without it.
  Likelihood suspicion(std::size_t index) const;
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
    double log_likelihood_before;  ///< of its candidate, before that day
    Eigen::VectorXd effect;        ///< of a unit step on the state's mean
    Likelihood size;               ///< of the step
  };
  struct Suspicion {
    Eigen::VectorXd effect;  ///< of the errors on the state's mean
    Likelihood factor;
  };
  /// One candidate: w with this standard deviation and time constant.
  struct Candidate {
    double wander, wander_d;
    Eigen::VectorXd mean;  ///< coefficients, w
    Eigen::MatrixXd covariance;
    double log_likelihood = 0;
    std::vector<Bet> bets;  ///< oldest first, alike in all candidates
    std::vector<Suspicion> suspicions;
  };
  void update(Candidate& candidate, double day, double days, const Eigen::VectorXd& regressors,
              double regressors_doubt, double value, double variance,
              const Eigen::MatrixXd& errors);
  const Candidate& likeliest() const;
  struct Claim {
    double size, std_error, log_ratio;
  };
  Claim claim_of(const Bet& bet) const;
  double capital_of(std::size_t bet, double& largest);
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
