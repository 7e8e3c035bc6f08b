// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tests/study/hidden.h"

namespace framewatch::study {
namespace {

double sign(double x) {
  return x < 0 ? -1 : 1;
}

/// f(t, d, v) without memory.
class PlainLaw : public estimator::ElementLaw {
 public:
  using Function = std::function<double(double t, double d, double v)>;
  PlainLaw(Function f, double stiffness) : f_(std::move(f)), stiffness_(stiffness) {}
  double force(double t, double d, double v, std::span<const double>) const override {
    return f_(t, d, v);
  }
  double stiffness_bound() const override { return stiffness_; }

 private:
  Function f_;
  double stiffness_;
};

/// Sliders in parallel that yield at different, possibly asymmetric, deformations. With `loss` the
/// limits fall by the factor exp(-loss work).
class Sliders : public estimator::ElementLaw {
 public:
  struct Part {
    double k, down, up, slider = 0;
  };
  explicit Sliders(std::vector<Part> parts, double loss = 0)
      : parts_(std::move(parts)), loss_(loss) {}
  double force(double, double d, double, std::span<const double>) const override {
    double sum = 0;
    for (const Part& p : parts_) sum += p.k * elastic(p, d);
    return sum;
  }
  void begin_step(double, double d) override {
    for (Part& p : parts_) {
      const double e = elastic(p, d);
      work_ += std::abs(p.k * e * (d - e - p.slider));
      p.slider = d - e;
    }
  }
  double stiffness_bound() const override {
    double sum = 0;
    for (const Part& p : parts_) sum += p.k;
    return sum;
  }

 private:
  double elastic(const Part& p, double d) const {
    const double left = std::exp(-loss_ * work_);
    return std::clamp(d - p.slider, -left * p.down, left * p.up);
  }

  std::vector<Part> parts_;
  double loss_, work_ = 0;
};

/// A brace that yields in both directions, hardens, and stays slack by its plastic deformation.
class SlackBrace : public estimator::ElementLaw {
 public:
  SlackBrace(double stiffness, double yield) : k_(stiffness), yield_(yield) {}
  double force(double, double d, double, std::span<const double>) const override {
    return k_ * (std::clamp(d - up_, 0.0, limit(up_)) - std::clamp(-d - down_, 0.0, limit(down_)));
  }
  void begin_step(double, double d) override {
    up_ = std::max(up_, d - limit(up_));
    down_ = std::max(down_, -d - limit(down_));
  }
  double stiffness_bound() const override { return k_; }

 private:
  double limit(double slack) const { return yield_ + kHardens * slack; }

  static constexpr double kHardens = 0.15;
  double k_, yield_, up_ = 0, down_ = 0;
};

/// A wall of concrete: half cycles aim at the largest displacement so far, the force grows by a
/// share of the first stiffness after yielding (Clough and Johnston 1966).
class ConcreteWall : public estimator::ElementLaw {
 public:
  ConcreteWall(double stiffness, double yield)
      : k_(stiffness), top_(yield), bottom_(-yield), yield_(yield) {}
  double force(double, double d, double, std::span<const double>) const override {
    if (d == d_) return f_;
    const bool up = d > d_;
    const double peak = up ? top_ : bottom_;
    const double elastic = f_ + k_ * (d - d_);
    if (up ? f_ < 0 : f_ > 0) {  // unloads first
      const double zero = d_ - f_ / k_;
      if (up ? d <= zero : d >= zero) return elastic;
      return beyond(d, zero, 0, peak);
    }
    return beyond(d, d_, f_, peak);
  }
  void begin_step(double time_s, double d) override {
    f_ = force(time_s, d, 0, {});
    d_ = d;
    top_ = std::max(top_, d);
    bottom_ = std::min(bottom_, d);
  }
  double stiffness_bound() const override { return k_; }

 private:
  static constexpr double kHardens = 0.04;
  double envelope(double d) const {
    return std::copysign(k_ * (yield_ + kHardens * (std::abs(d) - yield_)), d);
  }
  double beyond(double d, double from, double f, double peak) const {
    if (std::abs(d) >= std::abs(peak) && d * peak > 0) return envelope(d);
    return f + (envelope(peak) - f) * (d - from) / (peak - from);
  }

  double k_, top_, bottom_, yield_, d_ = 0, f_ = 0;
};

double softplus(double x) {
  return x > 30 ? x : std::log1p(std::exp(x));
}

struct LawScale {
  double k, d, v, seconds;
};

std::unique_ptr<estimator::ElementLaw> plain(PlainLaw::Function f, double stiffness) {
  return std::make_unique<PlainLaw>(std::move(f), stiffness);
}

/// Returns laws with sliders, or null if the name belongs to another law.
std::unique_ptr<estimator::ElementLaw> make_sliding(const std::string& name, const LawScale& e,
                                                    double s, double u) {
  if (name == "stick and slip")
    return std::make_unique<Sliders>(
        std::vector<Sliders::Part>{{10 * e.k, 0.1 * s * e.d, 0.1 * s * e.d}});
  if (name == "three sliders") {
    std::vector<Sliders::Part> parts;
    for (const double dy : {0.15, 0.3, 0.6}) parts.push_back({s * e.k / 3, dy * e.d, dy * e.d});
    return std::make_unique<Sliders>(parts);
  }
  if (name == "twelve sliders") {
    std::vector<Sliders::Part> parts;
    for (int i = 1; i <= 12; ++i) parts.push_back({s * e.k / 12, 0.09 * i * e.d, 0.09 * i * e.d});
    return std::make_unique<Sliders>(parts);
  }
  if (name == "yielding that tires") {
    const double dy = (0.25 + 0.2 * u) * e.d;
    return std::make_unique<Sliders>(std::vector<Sliders::Part>{{s * e.k, dy, dy}},
                                     0.02 / (s * e.k * dy * dy));
  }
  if (name == "slack brace") return std::make_unique<SlackBrace>(s * e.k, (0.2 + 0.2 * u) * e.d);
  if (name == "concrete wall")
    return std::make_unique<ConcreteWall>(s * e.k, (0.15 + 0.25 * u) * e.d);
  if (name == "lopsided yield")
    return std::make_unique<Sliders>(std::vector<Sliders::Part>{{s * e.k, 0.12 * e.d, 0.5 * e.d}});
  return nullptr;
}

std::unique_ptr<estimator::ElementLaw> make_other(const std::string& name, const LawScale& e,
                                                  double s, double u, int record) {
  if (auto sliding = make_sliding(name, e, s, u)) return sliding;
  if (name == "smooth gap") {
    const double g = (0.3 + 0.3 * u) * e.d, w = 0.1 * e.d;
    return plain(
        [=](double, double d, double) {
          return s * e.k * w * (softplus((d - g) / w) - softplus((-d - g) / w));
        },
        s * e.k);
  }
  if (name == "power 2.5")
    return plain([=](double, double d,
                     double) { return s * e.k * e.d * sign(d) * std::pow(std::abs(d) / e.d, 2.5); },
                 3 * s * e.k);
  if (name == "damping power 1.6")
    return plain(
        [=](double, double, double v) {
          return s * e.k * e.d * sign(v) * std::pow(std::abs(v) / e.v, 1.6);
        },
        0);
  if (name == "whole frame softens")
    return plain(
        [=](double, double d, double) {
          const double z = s * std::abs(d) / e.d;
          return -e.k * d * z / (1 + z);
        },
        e.k);
  if (name == "smooth drop") {
    const double at = (record == 0 ? 0.3 + 0.2 * u : 0.6 - 0.2 * u) * e.seconds;
    return plain([=](double t, double d,
                     double) { return -s * e.k * d * 0.5 * (1 + std::tanh((t - at) / 1.5)); },
                 s * e.k);
  }
  if (name == "tanh softening")  // with a spring that the building has lost
    return plain(
        [=](double, double d, double) { return s * e.k * 0.4 * e.d * std::tanh(d / (0.4 * e.d)); },
        s * e.k);
  if (name == "two-slope softening") {
    const double g = (0.3 + 0.2 * u) * e.d;
    return plain([=](double, double d, double) { return -s * e.k * (d - std::clamp(d, -g, g)); },
                 s * e.k);
  }
  if (name == "Stribeck friction")
    return plain(
        [=](double, double, double v) {
          const double x = v / (0.15 * e.v);
          return 0.2 * s * e.k * e.d * (1 + 0.7 / (1 + x * x)) * (2 / M_PI) *
                 std::atan(v / (0.005 * e.v));
        },
        0);
  if (name == "stop with a dashpot") {
    const double g = (0.35 + 0.3 * u) * e.d;
    return plain(
        [=](double, double d, double v) {
          return d > g ? s * e.k * std::max(3 * (d - g) + 0.5 * e.d * v / e.v, 0.0) : 0.0;
        },
        3 * s * e.k);
  }
  if (name == "wavy spring")
    return plain([=](double, double d,
                     double) { return s * e.k * e.d * 0.2 * std::sin(2 * M_PI * d / (0.5 * e.d)); },
                 2.6 * s * e.k);
  if (name == "pulsing stiffness") {
    const double w = 0.6 * e.v / e.d;
    return plain([=](double t, double d, double) { return s * e.k * d * std::sin(w * t); },
                 s * e.k);
  }
  // "damping that grows": d^2 v
  return plain(
      [=](double, double d, double v) { return s * e.k * e.d * d * d * v / (e.d * e.d * e.v); }, 0);
}

std::vector<std::string> accepted(const std::string& name) {
  if (name == "smooth gap") return {"two_sided_gap", "cubic_stiffness"};
  if (name == "power 2.5") return {"cubic_stiffness", "quadratic_stiffness"};
  if (name == "damping power 1.6") return {"quadratic_damping"};
  if (name == "stick and slip") return {"coulomb_friction", "bilinear_hysteresis", "bouc_wen"};
  if (name == "three sliders" || name == "twelve sliders" || name == "yielding that tires")
    return {"bilinear_hysteresis", "bouc_wen"};
  if (name == "slack brace") return {"pinching"};
  if (name == "concrete wall" || name == "lopsided yield") return {"bilinear_hysteresis"};
  if (name == "whole frame softens") return {"amplitude_dependence"};
  if (name == "smooth drop") return {"stiffness_drop", "stiffness_drift"};
  if (name == "tanh softening" || name == "two-slope softening")
    return {"quadratic_stiffness", "cubic_stiffness"};
  if (name == "Stribeck friction") return {"coulomb_friction"};
  if (name == "stop with a dashpot") return {"one_sided_gap"};
  return {};
}

estimator::LawKind sort_of(const std::string& name) {
  using enum estimator::LawKind;
  static const std::map<std::string, estimator::LawKind> kSorts{
      {"smooth gap", elastic},
      {"power 2.5", elastic},
      {"damping power 1.6", dissipative},
      {"stick and slip", hysteretic},
      {"three sliders", hysteretic},
      {"smooth drop", time_varying},
      {"tanh softening", elastic},
      {"two-slope softening", elastic},
      {"Stribeck friction", dissipative},
      {"stop with a dashpot", impact},
      {"twelve sliders", hysteretic},
      {"yielding that tires", hysteretic},
      {"slack brace", hysteretic},
      {"concrete wall", hysteretic},
      {"whole frame softens", elastic},
      {"lopsided yield", hysteretic},
      {"wavy spring", elastic},
      {"damping that grows", dissipative},
      {"pulsing stiffness", time_varying}};
  return kSorts.at(name);
}

bool takes_over(const std::string& name) {
  return name == "three sliders" || name == "twelve sliders" || name == "yielding that tires" ||
         name == "slack brace" || name == "concrete wall" || name == "lopsided yield" ||
         name == "tanh softening";
}

}  // namespace

const std::vector<std::string>& other_forms() {
  static const std::vector<std::string> kNames{
      "smooth gap",        "power 2.5",           "damping power 1.6", "stick and slip",
      "three sliders",     "smooth drop",         "tanh softening",    "two-slope softening",
      "Stribeck friction", "stop with a dashpot", "twelve sliders",    "yielding that tires",
      "slack brace",       "whole frame softens", "concrete wall",     "lopsided yield"};
  return kNames;
}

const std::vector<std::string>& outsiders() {
  static const std::vector<std::string> kNames{"wavy spring", "damping that grows",
                                               "pulsing stiffness"};
  return kNames;
}

Draw draw_law(const std::string& name, const StudyBuilding& b, const Peaks& peaks,
              estimator::Random& random) {
  estimator::EffectPlace place;
  place.kind = estimator::PlaceKind::frame;
  place.story = 1 + static_cast<int>(random.uniform() * b.truth.stories);
  place.frame = static_cast<int>(random.uniform() * b.truth.frames());
  if (name == "whole frame softens") {
    place.kind = estimator::PlaceKind::whole_frame;
    place.story = 0;
  }
  const double u = random.uniform();
  Draw draw;
  draw.name = name;
  draw.largest = takes_over(name)                ? 0.9
                 : name == "smooth drop"         ? 0.7
                 : name == "two-slope softening" ? 0.6
                 : name == "pulsing stiffness"   ? 0.5
                                                 : 2;
  draw.make = [=](double s, Hidden& hidden) {
    const int i = b.table().frame_stiffness(std::max(place.story, 1), place.frame);
    const LawScale e{b.theta[i], peaks.deformation[i], peaks.rate[i], peaks.seconds};
    if (takes_over(name)) hidden.theta[i] -= s * e.k;
    hidden.laws.push_back({name, accepted(name), sort_of(name), place,
                           [=](int record) { return make_other(name, e, s, u, record); }});
  };
  return draw;
}

}  // namespace framewatch::study
