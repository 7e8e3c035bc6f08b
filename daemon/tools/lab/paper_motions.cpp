#include "daemon/tools/lab/paper_motions.h"

#include "daemon/tools/simulation/scenario_motion.h"

namespace framewatch::daemon {
namespace {

std::optional<estimator::GroundMotion> read(const std::string& path,
                                            const MotionFileFormat& format) {
  std::string problem;
  estimator::GroundMotion motion = read_recorded_motion(path, format, problem);
  if (!problem.empty()) return std::nullopt;
  return motion;
}

}  // namespace

std::optional<estimator::GroundMotion> el_centro_ns(const std::string& data) {
  return read(data + "/ground_motions/elcentro_NS.dat", {"g", 0, ""});
}

std::optional<estimator::GroundMotion> hachinohe_ns(const std::string& data) {
  return read(data + "/ground_motions/hachi.txt", {"gal", 0.01, ""});
}

}  // namespace framewatch::daemon
