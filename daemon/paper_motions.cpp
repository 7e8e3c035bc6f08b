#include "daemon/paper_motions.h"

#include "daemon/recorded_motion.h"

namespace framewatch::daemon {
namespace {

std::optional<GroundMotion> read(const std::string& path, const MotionFileFormat& format) {
  std::string problem;
  GroundMotion motion = read_recorded_motion(path, format, problem);
  if (!problem.empty()) return std::nullopt;
  return motion;
}

}  // namespace

std::optional<GroundMotion> el_centro_ns(const std::string& data) {
  return read(data + "/ground_motions/elcentro_NS.dat", {"g", 0, ""});
}

std::optional<GroundMotion> hachinohe_ns(const std::string& data) {
  return read(data + "/ground_motions/hachi.txt", {"gal", 0.01, ""});
}

}  // namespace framewatch::daemon
