// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/monitor/estimates/estimate_table.h"
#include "estimator/identify/estimate/estimate.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// The main window's estimates of a whole replay, by parameter.
class EstimateSeries {
 public:
  /// `with_errors` keeps the standard errors, too; `min_snr` is estimator.min_snr.
  EstimateSeries(const estimator::ParameterTable& table, bool with_errors,
                 double min_snr = estimator::EstimatorOptions{}.min_snr);

  void add(const estimator::WindowEstimate& estimate);

  struct Series {
    std::string name, unit;
    estimator::ParameterKind kind;
    std::vector<double> value;                     ///< by window, SI; NaN if it is not observable
    std::vector<float> std_error;                  ///< by window, SI; NaN if it is not observable
    std::array<std::int64_t, kReasons> reasons{};  ///< windows by told_reason()
  };
  const std::vector<Series>& parameters() const { return parameters_; }
  const std::vector<std::int64_t>& end_us() const { return end_us_; }
  std::int64_t windows() const { return static_cast<std::int64_t>(end_us_.size()); }

  struct Range {
    std::size_t begin, end;
  };
  /// Returns the windows that end in [from_us, to_us].
  Range range(std::int64_t from_us, std::int64_t to_us) const;
  Range all() const { return {0, end_us_.size()}; }

  struct Quartiles {
    double q1, median,
        q3;                   ///< of the observable windows, by MATLAB's rule; NaN without any
    double observable_ratio;  ///< share of all windows of the range; NaN if it is empty
  };
  /// Returns the quartiles of a parameter over the windows of a range.
  Quartiles quartiles(const Series& series, Range range) const;

 private:
  bool with_errors_;
  double min_snr_;
  std::vector<Series> parameters_;
  std::vector<std::int64_t> end_us_;
};

/// Returns the quartiles by MATLAB's rule: sorted value i of n has probability (i - 0.5) / n,
/// linear between. Ignores NaN.
std::array<double, 3> quartiles_of(std::vector<double> values);

}  // namespace framewatch::daemon
