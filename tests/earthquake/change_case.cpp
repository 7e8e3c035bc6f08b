// SPDX-License-Identifier: MIT
#include "tests/earthquake/change_case.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "estimator/structure/group_design.h"

namespace framewatch::earthquake {
namespace {

constexpr double kMassOff = 0.02, kProfileOff = 0.05;  // standard deviations
constexpr double kDesignOff = 0.15;                    // at most
constexpr double kMinLoss = 0.05, kMaxLoss = 0.40, kUniformLoss = 0.05;
// Limits of the slow softening. Slip scatters from window to window, and with more of it no
// baseline is learned within kLearned_s.
constexpr double kMinSoftening = 0.05, kMaxSoftening = 0.20, kSlipOfThat = 0.4;
constexpr double kTwoElements = 1.0 / 3, kApart = 0.5;  // shares of cases
constexpr double kMinApart_s = 2, kMaxApart_s = 8;
constexpr double kLoud = 2.5;
// Levels of the ground's motion and the end of each, s.
constexpr double kAmbient = 0.02, kCoda = 0.5;
constexpr double kLearn[][2] = {{20, 0.6}, {40, 0.2}, {60, 1.0}, {80, 0.4}, {100, 0.8}};
constexpr double kQuake_s = 105, kPause_s = 120, kAgain_s = 130, kOver_s = 135, kOverAgain_s = 145;

double between_of(estimator::Random& random, double least, double most) {
  return least + (most - least) * random.uniform();
}

StudyBuilding draw_building(estimator::Random& random) {
  const double u = random.uniform();
  if (u < 0.30) return three_stories();
  if (u < 0.50) return two_stories_in_space();
  if (u < 0.65) return stories_with_channels(6, {1, 2, 3, 4, 5, 6});
  if (u < 0.85) return stories_with_channels(6, {2, 4, 6});
  return stories_with_channels(12, {3, 6, 9, 12});
}

/// Draws a truth that differs from the estimator's design.
void draw_errors(estimator::Random& random, ChangeCase& out) {
  out.truly = out.told.config.structure;
  out.theta = design_off(out.told.config, kDesignOff, out.seed + 7);
  if (!out.model_error) return;
  const estimator::ParameterTable stories(out.truly);
  for (double& mass : out.truly.node_mass) mass *= std::exp(kMassOff * random.normal());
  if (!out.grouped()) return;
  for (int i = 0; i < stories.elements(); ++i) {
    const double profile = std::exp(kProfileOff * random.normal());
    out.theta[i] *= profile;
    out.theta[i + stories.elements()] *= profile;
  }
}

void draw_losses(estimator::Random& random, ChangeCase& out) {
  const double at_s = out.between ? between_of(random, kPause_s + 1, kAgain_s - 1)
                                  : between_of(random, kQuake_s + 5, kPause_s + 2);
  if (out.kind == ChangeKind::none) return;
  const estimator::ParameterTable stories(out.truly);
  std::vector<int> frames;
  for (int i = 0; i < stories.elements(); ++i)
    if (stories[i].kind == estimator::ParameterKind::frame_stiffness) frames.push_back(i);
  if (out.kind == ChangeKind::uniform) {
    for (int i = 0; i < stories.elements(); ++i) out.losses.push_back({at_s, i, kUniformLoss});
    return;
  }
  const bool two = random.uniform() < kTwoElements, apart = random.uniform() < kApart;
  const double later_s = at_s + (apart ? between_of(random, kMinApart_s, kMaxApart_s) : 0);
  for (const double time_s : {at_s, later_s}) {
    const auto drawn =
        static_cast<std::ptrdiff_t>(random.uniform() * static_cast<double>(frames.size()));
    out.losses.push_back(
        {time_s, frames[static_cast<std::size_t>(drawn)], between_of(random, kMinLoss, kMaxLoss)});
    frames.erase(frames.begin() + drawn);
    if (!two) break;
  }
}

}  // namespace

ChangeCase change_case(ChangeKind kind, std::uint64_t seed, int number) {
  estimator::Random random(
      seed, 1000 * static_cast<std::uint64_t>(kind) * 1000 + static_cast<std::uint64_t>(number));
  ChangeCase out;
  out.kind = kind;
  out.seed = 1'000'000 * seed + 10'000 * static_cast<std::uint64_t>(kind) +
             static_cast<std::uint64_t>(number);
  out.told = draw_building(random);
  out.model_error = random.uniform() < 0.5;
  const double u = random.uniform();
  out.softening = u < 0.5 ? Softening::none : u < 0.75 ? Softening::slow : Softening::slipping;
  out.amount = between_of(random, kMinSoftening, kMaxSoftening);
  if (out.softening == Softening::slipping) out.amount *= kSlipOfThat;
  out.between = random.uniform() < 0.5;
  out.loud = random.uniform() < 0.5;
  draw_errors(random, out);
  draw_losses(random, out);
  return out;
}

double ChangeCase::level(double t) const {
  for (const auto& [until_s, learned] : kLearn)
    if (t < until_s) return learned;
  const double strong = loud ? kLoud : 1;
  if (t < kQuake_s) return kAmbient;
  if (t < kPause_s) return strong;
  if (!between) return t < kOver_s ? strong : kCoda;
  if (t < kAgain_s) return kAmbient;
  return t < kOverAgain_s ? strong : kCoda;
}

double ChangeCase::visible_s(double change_s) const {
  return between && change_s < kAgain_s ? kAgain_s : change_s;
}

Eigen::VectorXd ChangeCase::remaining(double t) const {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(theta.size() / 2);
  for (const Loss& loss : losses)
    if (t >= loss.at_s) out[loss.element] *= 1 - loss.ratio;
  return out;
}

std::vector<double> ChangeCase::truth(double t) const {
  const estimator::ParameterTable table = told.config.parameters();
  Eigen::VectorXd now = theta;
  now.head(theta.size() / 2).array() *= remaining(t).array();
  const auto identified = [&](const Eigen::VectorXd& of) {
    return table.grouped() ? group_parameters(truly, table, {of, {}}) : of;
  };
  const Eigen::VectorXd before = identified(theta), after = identified(now);
  std::vector<double> out(static_cast<std::size_t>(table.size()), 0);
  for (int p = 0; p < table.elements(); ++p)
    out[static_cast<std::size_t>(p)] = after[p] / before[p] - 1;
  return out;
}

std::string ChangeCase::text() const {
  const estimator::ParameterTable stories(truly);
  std::string out = told.name;
  if (model_error) out += ", masses and profiles off";
  if (softening == Softening::slow) out += fmt::format(", softens slowly by {:.2f}", amount);
  if (softening == Softening::slipping) out += fmt::format(", slips, {:.2f}", amount);
  out += between ? ", between two motions" : ", in strong motion";
  if (loud) out += ", stronger than learned";
  if (kind == ChangeKind::uniform) return out + ": all lose 5 %";
  for (const Loss& loss : losses)
    out += fmt::format("; {} loses {:.1f} % at {:.2f} s", stories[loss.element].name,
                       100 * loss.ratio, loss.at_s);
  return out;
}

}  // namespace framewatch::earthquake
