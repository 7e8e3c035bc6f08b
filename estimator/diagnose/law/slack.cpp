#include "estimator/diagnose/law/slack.h"

#include <algorithm>

namespace framewatch::estimator {

std::vector<double> first_slack(const std::vector<double>& p) {
  return {p[SlackIndex::play], p[SlackIndex::play]};
}

double slack_force(const std::vector<double>& p, const std::vector<double>& slack, double d) {
  return std::clamp(d - slack[0], 0.0, p[SlackIndex::dy]) -
         std::clamp(-d - slack[1], 0.0, p[SlackIndex::dy]);
}

void slacken(const std::vector<double>& p, std::vector<double>& slack, double d) {
  slack[0] = std::max(slack[0], d - p[SlackIndex::dy]);
  slack[1] = std::max(slack[1], -d - p[SlackIndex::dy]);
}

}  // namespace framewatch::estimator
