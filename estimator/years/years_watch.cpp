// SPDX-License-Identifier: MIT
#include "estimator/years/years_watch.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {
namespace {

/// Prior of what a unit of a regressor (10 degC) does: of all elements alike, and of one against
/// the others. Buildings are known to change by up to 0.3 % per degC.
constexpr double kUsualOfAll = 0.03, kUsualOfOne = 0.015;
constexpr double kLevel = 1;  // prior of the level, which is not known at the start
/// An element without a value stands where it usually does beside the others, within this error.
constexpr double kUnseen = 0.005, kUsual_d = 30;

Eigen::VectorXd prior_of(int regressors, double usual) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(regressors, usual);
  out[0] = kLevel;
  return out;
}

bool is_value(const DayValue& v) {
  return v.value > 0 && v.std_error > 0 && std::isfinite(v.value) && std::isfinite(v.std_error);
}

}  // namespace

void DayMean::push(double value, double std_error) {
  if (!is_value({value, std_error})) return;
  if (count_++ == 0) first_ = value;
  const double weight = 1 / (std_error * std_error), off = value - first_;
  weight_ += weight;
  sum_ += weight * off;
  square_ += weight * off * off;
}

DayValue DayMean::mean() const {
  if (count_ == 0) return {kNaN, kNaN};
  const double mean = sum_ / weight_;
  const double scatter = count_ > 1 ? (square_ / weight_ - mean * mean) / (count_ - 1) : 0;
  return {first_ + mean, std::sqrt(std::max(1 / weight_, scatter))};
}

YearsWatch::YearsWatch(std::size_t elements, const std::vector<Covariate>& covariates,
                       const LifeBudget& budget)
    : elements_(elements), weather_(covariates) {
  const double life_d = WeatherLags::kYear_d * budget.years,
               least = -std::log1p(-budget.least_loss);
  if (elements > 1)
    series_.assign(elements, LossEvidence(prior_of(weather_.size(), kUsualOfOne), life_d, least));
  series_.emplace_back(prior_of(weather_.size(), kUsualOfAll), life_d, least);
  // All series share the budget.
  proof_ = std::log(static_cast<double>(series_.size()) / budget.probability);
}

const LossEvidence& YearsWatch::series(int element) const {
  return element == kAllAlike || series_.size() == 1 ? series_.back()
                                                     : series_[static_cast<std::size_t>(element)];
}

Eigen::VectorXd YearsWatch::weather_effect(std::size_t element) const {
  Eigen::VectorXd out = series_.back().coefficients();
  // A series of one element is its difference from the mean of the others.
  const auto n = static_cast<double>(elements_.size());
  if (series_.size() > 1) out += (n - 1) / n * series_[element].coefficients();
  out[0] = 0;
  return out;
}

Eigen::VectorXd YearsWatch::regressors() const {
  return std::isfinite(weather_.doubt()) ? weather_.regressors() : Eigen::VectorXd();
}

double YearsWatch::evidence(int element) const {
  return std::max(series(element).log_capital(), 0.0) / proof_;
}

/// Brings every element to the present day. Returns false if none has a value.
bool YearsWatch::take(double days, const std::vector<DayValue>& values) {
  int seen = 0;
  double all = 0;
  for (std::size_t p = 0; p < elements_.size(); ++p) {
    Element& e = elements_[p];
    if (!is_value(values[p]) || !e.known) continue;
    all += std::log(values[p].value) - e.reference - e.usual;
    ++seen;
  }
  const bool first =
      std::none_of(elements_.begin(), elements_.end(), [](const Element& e) { return e.known; });
  if (seen == 0 && !first) return false;
  if (seen > 0) all /= seen;
  const double rate = 1 - std::exp(-days / kUsual_d);
  bool any = false;
  for (std::size_t p = 0; p < elements_.size(); ++p) {
    Element& e = elements_[p];
    const bool has = is_value(values[p]);
    if (has && !e.known) {
      e.known = true;
      e.reference = std::log(values[p].value) - all;
    }
    e.now = has ? std::log(values[p].value) - e.reference : all + e.usual;
    const double relative = has ? values[p].std_error / values[p].value : kUnseen;
    e.variance = relative * relative;
    if (has) e.usual += rate * (e.now - all - e.usual);
    any = any || has;
  }
  return any;
}

void YearsWatch::begin_anew() {
  std::ranges::fill(elements_, Element());
  for (LossEvidence& series : series_) series.accept(kLevel);
}

std::optional<YearsWatch::Finding> YearsWatch::push(double day, const std::vector<DayValue>& values,
                                                    const std::vector<double>& weather) {
  weather_.push(day, weather);
  const double doubt = weather_.doubt();
  if (!std::isfinite(doubt) || !take(days_ > 0 ? day - last_day_ : 0, values)) return std::nullopt;
  last_day_ = day;
  ++days_;
  const auto n = static_cast<double>(elements_.size());
  double sum = 0, variance = 0;
  for (const Element& e : elements_) sum += e.now, variance += e.variance;
  for (std::size_t p = 0; p + 1 < series_.size(); ++p) {
    const Element& e = elements_[p];
    if (!is_value(values[p])) continue;
    const double others = (sum - e.now) / (n - 1);
    series_[p].push(day, weather_.regressors(), doubt, e.now - others,
                    e.variance + (variance - e.variance) / ((n - 1) * (n - 1)));
  }
  series_.back().push(day, weather_.regressors(), doubt, sum / n, variance / (n * n));

  const auto most = std::max_element(series_.begin(), series_.end(), [](auto& a, auto& b) {
    return a.log_capital() < b.log_capital();
  });
  if (most->log_capital() < proof_) return std::nullopt;
  const LossEvidence::Step step = most->step();
  const bool all = most + 1 == series_.end();
  const auto which = static_cast<std::size_t>(most - series_.begin());
  for (std::size_t p = 0; p < elements_.size(); ++p)
    if (all || p == which) elements_[p].reference += step.size;
  most->accept(step.std_error);
  const double ratio = std::exp(step.size);
  return Finding{all && elements_.size() > 1 ? kAllAlike : static_cast<int>(all ? 0 : which), day,
                 step.day, ratio - 1, ratio * step.std_error};
}

}  // namespace framewatch::estimator
