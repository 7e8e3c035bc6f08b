// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/search_settings.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace framewatch::estimator {
namespace {

constexpr SearchSetting kSettings[] = {
    {"significant", &SearchSettings::significant, 1, 20},
    {"min_gain", &SearchSettings::min_gain, 1, 1000},
    {"same_cost", &SearchSettings::same_cost, 0, 200},
    {"doubt_cost", &SearchSettings::doubt_cost, 1, 1000},
    {"surest", &SearchSettings::surest, 0.5, 1},
    {"implausible_masses", &SearchSettings::implausible_masses, 1, 1000},
    {"mass_std", &SearchSettings::mass_std, 0, 20},
    {"sharp", &SearchSettings::sharp, 0, 1},
    {"explains", &SearchSettings::explains, 0, 1},
    {"explains_most", &SearchSettings::explains_most, 0, 1},
    {"explains_much", &SearchSettings::explains_much, 0, 1},
    {"promises", &SearchSettings::promises, 0, 1},
    {"pair_leaves", &SearchSettings::pair_leaves, 0, 1},
    {"kind_leaves", &SearchSettings::kind_leaves, 0, 1},
    {"separate", &SearchSettings::separate, 0, 1},
    {"to_explain", &SearchSettings::to_explain, 1, 3},
    {"adequate", &SearchSettings::adequate, 1, 10},
    {"near_noise", &SearchSettings::near_noise, 1, 10},
    {"one_place", &SearchSettings::one_place, 1, 20},
    {"noise_at_place", &SearchSettings::noise_at_place, 1, 100},
    {"far_off", &SearchSettings::far_off, 1, 1000},
    {"most_of_noise", &SearchSettings::most_of_noise, 1, 10000},
    {"as_likely", &SearchSettings::as_likely, 1, 20},
    {"place_margin", &SearchSettings::place_margin, 0, 2},
    {"clearer", &SearchSettings::clearer, 0, 1},
    {"noise_spread", &SearchSettings::noise_spread, 1, 20},
    {"perhaps_noise_spread", &SearchSettings::perhaps_noise_spread, 1, 200},
    {"same_corner", &SearchSettings::same_corner, 0, 1},
    {"outlier_std", &SearchSettings::outlier_std, 1, 20},
    {"cells_of_noise", &SearchSettings::cells_of_noise, 0.1, 1},
    {"same_gap", &SearchSettings::same_gap, 0, 0.5},
    {"clearly_less", &SearchSettings::clearly_less, 0, 1},
    {"leads", &SearchSettings::leads, 0, 1},
    {"pays", &SearchSettings::pays, 0, 1},
    {"damping_pays", &SearchSettings::damping_pays, 0, 1},
    {"nearly_best", &SearchSettings::nearly_best, 1, 3},
    {"undetermined", &SearchSettings::undetermined, 1, 10},
    {"at_floor", &SearchSettings::at_floor, 1, 10},
    {"near_floor", &SearchSettings::near_floor, 1, 20},
    {"hopeless", &SearchSettings::hopeless, 1, 100},
    {"behind", &SearchSettings::behind, 0, 20},
    {"leaves_little", &SearchSettings::leaves_little, 0, 1},
    {"useless", &SearchSettings::useless, 0, 1},
    {"promised_by_step", &SearchSettings::promised_by_step, 0, 1},
    {"kind_follows", &SearchSettings::kind_follows, 0, 1},
    {"simpler_kind", &SearchSettings::simpler_kind, 0, 1},
    {"beyond_linear", &SearchSettings::beyond_linear, 1, 10},
    {"as_impact", &SearchSettings::as_impact, 0, 1},
    {"follows", &SearchSettings::follows, 0, 1},
    {"follows_at_rest", &SearchSettings::follows_at_rest, 0, 1},
    {"some_at_rest", &SearchSettings::some_at_rest, 0, 1},
    {"much_at_rest", &SearchSettings::much_at_rest, 0, 1},
    {"at_rest", &SearchSettings::at_rest, 0, 1},
    {"stands_out", &SearchSettings::stands_out, 1, 100},
    {"quadratic", &SearchSettings::quadratic, 1.2, 9},
    {"no_power", &SearchSettings::no_power, 0, 1},
    {"rigid", &SearchSettings::rigid, 0, 1},
    {"slips", &SearchSettings::slips, 1, 10},
    {"sudden", &SearchSettings::sudden, 0, 1},
    {"dissipates", &SearchSettings::dissipates, 0, 1},
    {"narrowest_slip", &SearchSettings::narrowest_slip, 0, 1},
    {"dulled", &SearchSettings::dulled, 0, 2},
    {"small_start", &SearchSettings::small_start, 0, 1},
    {"places", &SearchSettings::places, 1, 100},
    {"of_one_sort", &SearchSettings::of_one_sort, 1, 100},
    {"of_the_building", &SearchSettings::of_the_building, 1, 100},
    {"as_likely_places", &SearchSettings::as_likely_places, 1, 100},
    {"pair_leaders", &SearchSettings::pair_leaders, 1, 100},
    {"laws", &SearchSettings::laws, 1, 100},
    {"finalists", &SearchSettings::finalists, 1, 100},
    {"laws_of_pair", &SearchSettings::laws_of_pair, 1, 100},
    {"causes", &SearchSettings::causes, 1, 100},
    {"labels", &SearchSettings::labels, 1, 100},
    {"linear_effects", &SearchSettings::linear_effects, 1, 100},
    {"dampers", &SearchSettings::dampers, 1, 100},
    {"first_steps", &SearchSettings::first_steps, 1, 100},
    {"rough_steps", &SearchSettings::rough_steps, 1, 100},
    {"steps", &SearchSettings::steps, 1, 100},
    {"long_steps", &SearchSettings::long_steps, 1, 100},
    {"longest_steps", &SearchSettings::longest_steps, 1, 100},
};

}  // namespace

double SearchSetting::of(const SearchSettings& settings) const {
  return std::visit([&](auto at) { return static_cast<double>(settings.*at); }, member);
}

void SearchSetting::set(SearchSettings& settings, double value) const {
  const double within = std::clamp(value, low, high);
  std::visit(
      [&](auto at) {
        using Number = std::remove_reference_t<decltype(settings.*at)>;
        settings.*at =
            static_cast<Number>(std::is_integral_v<Number> ? std::round(within) : within);
      },
      member);
}

std::span<const SearchSetting> search_settings() {
  return kSettings;
}

}  // namespace framewatch::estimator
