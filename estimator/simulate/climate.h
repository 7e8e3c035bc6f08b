// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {

/// A temperate climate and how a simulated building follows it. Ratios are relative changes of
/// stiffness; a negative one makes a building softer.
struct Climate {
  double mean_degc = 11, season_degc = 9;  ///< mean of years; half of summer less winter
  double day_degc = 4;                     ///< half of afternoon less night
  double front_degc = 3;                   ///< deviation of weather fronts, which last three days
  double mean_wind_mps = 3;
  double per_degc = -0.0012;           ///< ratio per degree, mean of the elements
  double frozen_per_degc = -0.0005;    ///< additional ratio per degree below 0
  double per_pct = -0.0002;            ///< ratio per percent of relative humidity
  double per_mps = -0.0005;            ///< ratio per m/s of wind, because motion softens
  double occupied_mass_ratio = 0.003;  ///< of the building's mass, on workdays from 8 to 18 h
  double spread_ratio = 0.4;           ///< deviation of an element's ratios from their mean
  double shortest_lag_days = 0.5, longest_lag_days = 6;  ///< behind the temperature, by element
  double wander_ratio = 0.002;        ///< deviation of an element's own slow changes
  double wander_alike_ratio = 0.003;  ///< deviation of slow changes of all elements
  double damping_exponent = -3;       ///< damping is stiffness to this power
};

/// Weather and use of the newest hour.
struct WeatherHour {
  double outside_degc = 0;
  double humidity_pct = 0;
  double wind_mps = 0;
  double occupied_pct = 0;
};

/// Simulates the weather hour by hour, and the stiffness of every element in it. Its lags and
/// shapes are not those that estimator/years assumes. The same seed gives the same hours on every
/// machine.
class ClimateStream {
 public:
  static constexpr double kStep_s = 3600;

  /// start_s: time of the first hour, seconds since 1970, UTC. elements: number of stiffnesses.
  ClimateStream(const Climate& climate, int elements, double start_s, std::uint64_t seed);

  /// Advances by an hour; the first call returns the first hour.
  const WeatherHour& next();
  /// Returns the factor on the stiffness of every element in the newest hour. A building that is
  /// heavier because it is occupied counts as softer, as in an estimate by its stated mass.
  const std::vector<double>& stiffness_factor() const { return factor_; }
  /// Returns the factor on the damping of an element in the newest hour.
  double damping_factor(int element) const;

 private:
  /// A quantity about zero that forgets its past with a time constant.
  class Wander {
   public:
    Wander(double deviation, double hours);
    double next(Random& random);

   private:
    double deviation_, kept_, now_ = 0;
  };
  struct Element {
    double per_degc, frozen_per_degc, per_pct, per_mps;
    double lag_kept;  ///< share of the difference to the temperature that is left after an hour
    Wander own;
    double degc;  ///< of the element itself
  };

  Climate climate_;
  std::int64_t hour_;  ///< since 1970
  bool began_ = false;
  Random random_;
  Wander front_, rain_, gusts_, alike_;
  WeatherHour weather_;
  double damp_pct_ = 0;  ///< humidity inside of walls
  std::vector<Element> elements_;
  std::vector<double> factor_;
};

}  // namespace framewatch::estimator
