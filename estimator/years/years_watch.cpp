// SPDX-License-Identifier: MIT
#include "estimator/years/years_watch.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"
#include "estimator/numeric/quantile.h"

namespace framewatch::estimator {
namespace {

/// Prior of what a unit of a regressor (10 degC) does: of all elements alike, and of one against
/// the others. Buildings are known to change by up to 0.3 % per degC.
constexpr double kUsualOfAll = 0.03, kUsualOfOne = 0.015;
constexpr double kLevel = 1;  // prior of the level, which is not known at the start
/// An element without a value stands where it usually does beside the others, within this error.
constexpr double kUnseen = 0.005, kUsual_d = 30;

/// A day's value that is so many times the usual one, or less than that share of it, is not the
/// stiffness: a sensor was wrong, or a unit. Damage that large comes to stay, and other watches
/// tell it the same minute.
constexpr double kFar = 1.6;
constexpr int kStays = 3;          // far values that are near each other
constexpr std::size_t kFirst = 5;  // values whose median is an element's first reference

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
    : elements_(elements), weather_(covariates), sensors_(covariates) {
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
  return std::max(series(element).log_capital() - sensors_.excuse(), 0.0) / proof_;
}

/// Removes values that are far from those of their element on the days before, until one has come
/// to stay. An element without a reference collects its first values, and begins again if no later
/// value is near them.
void YearsWatch::leave_out(std::vector<DayValue>& values) {
  std::vector<double> off;
  for (std::size_t p = 0; p < elements_.size(); ++p) {
    const Element& e = elements_[p];
    if (is_value(values[p]) && e.known)
      off.push_back(std::log(values[p].value) - e.reference - e.usual);
  }
  // The median of the elements, if it is near the one of the last day.
  const double all = off.empty() ? all_ : mean_median(off),
               from = std::abs(all - all_) < std::log(kFar) ? all : all_;
  for (std::size_t p = 0; p < elements_.size(); ++p) {
    Element& e = elements_[p];
    if (!is_value(values[p])) continue;
    const double log = std::log(values[p].value);
    if (!e.known) {
      e.first.push_back(log);
      e.known = e.first.size() == kFirst;
      if (e.known) e.reference = mean_median(e.first) - from;
    }
    if (!e.known) {
      values[p] = {kNaN, kNaN};
      continue;
    }
    if (std::abs(log - e.reference - e.usual - from) < std::log(kFar)) {
      e.near = true;
      e.away = 0;
      continue;
    }
    e.away = e.away > 0 && std::abs(log - e.far) < std::log(kFar) ? e.away + 1 : 1;
    e.far = log;
    if (e.away <= kStays || !e.near) values[p] = {kNaN, kNaN};
    if (e.away > kStays && !e.near) e = Element();
  }
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
  if (seen == 0) return false;
  all /= seen;
  all_ = all;
  const double rate = 1 - std::exp(-days / kUsual_d);
  for (std::size_t p = 0; p < elements_.size(); ++p) {
    Element& e = elements_[p];
    const bool has = is_value(values[p]);
    e.now = has ? std::log(values[p].value) - e.reference : all + e.usual;
    const double relative = has ? values[p].std_error / values[p].value : kUnseen;
    e.variance = relative * relative;
    if (has) e.usual += rate * (e.now - all - e.usual);
  }
  return true;
}

void YearsWatch::begin_anew() {
  std::ranges::fill(elements_, Element());
  for (LossEvidence& series : series_) series.accept(kLevel);
}

std::optional<YearsWatch::Finding> YearsWatch::push(double day, const std::vector<DayValue>& seen,
                                                    const std::vector<double>& readings) {
  const std::vector<double> weather = sensors_.correct(readings);
  weather_.push(day, weather);
  sensors_.push(day, weather_, weather, series_);
  const LossEvidence::Weather today{weather_.regressors(), weather_.doubt()};
  if (!std::isfinite(today.doubt) || std::ranges::none_of(seen, is_value)) return std::nullopt;
  const double days = days_++ > 0 ? day - last_day_ : 0;
  last_day_ = day;
  std::vector<DayValue> values = seen;
  leave_out(values);
  if (!take(days, values)) return std::nullopt;
  const auto n = static_cast<double>(elements_.size());
  double sum = 0, variance = 0;
  for (const Element& e : elements_) sum += e.now, variance += e.variance;
  for (std::size_t p = 0; p + 1 < series_.size(); ++p) {
    const Element& e = elements_[p];
    if (!is_value(values[p])) continue;
    const double others = (sum - e.now) / (n - 1);
    series_[p].push(day, today, e.now - others,
                    e.variance + (variance - e.variance) / ((n - 1) * (n - 1)), sensors_.weather());
  }
  series_.back().push(day, today, sum / n, variance / (n * n), sensors_.weather());
  sensors_.judge(series_);
  sensors_.adopt(proof_, weather_, series_);

  const auto most = std::max_element(series_.begin(), series_.end(), [](auto& a, auto& b) {
    return a.log_capital() < b.log_capital();
  });
  if (most->log_capital() - sensors_.excuse() < proof_) return std::nullopt;
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
