#include "core/detection/scan_axes/turn_evidence.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/evidence/share/surface_distance.h"
#include "core/geometry/point_samples.h"

namespace pcl_symmetry {

namespace {

// Points that judge a turn exactly, and roughly. chosen: standard errors of 0.7 and 1.2 % at a share of 0.05; half
// decides by chance, twice takes twice the time.
constexpr int kSamplesOfTurn = 1000, kFewSamplesOfTurn = 300;
constexpr double kFarTurn = 10.0;  // tolerances. derived: as ObjectSymmetryOptions::max_feature has it
// Widths of the weights of the fit, tolerances, from start to end. chosen: starts are off by a few degrees; half loses
// them, twice lets wrong matches pull.
constexpr std::array<double, 6> kFitWidths{8.0, 5.0, 3.0, 2.0, 1.5, 1.5};
constexpr double kFitReach = 2.0;   // widths beyond which a match has no weight. derived: exp(-4) = 0.02
constexpr double kFitRidge = 1e-3;  // share of the trace. chosen: keeps free directions, such as along a ball, at rest
constexpr double kFitStep = 1e-4;   // radians, radii; chosen: for derivatives in double precision
constexpr double kLeastTurnF = 1e-6;  // derived: below any f that is not 0

constexpr double kSlackOfReach = 1.001;  // derived: more than what distances are rounded by

/// Radius of the greatest disc that stands for a point.
double greatestDisc(const LocalGeometry& geometry) {
  return kDiscRadius * static_cast<double>(*std::max_element(geometry.spacing.begin(), geometry.spacing.end()));
}

Eigen::Isometry3d turnAbout(const Line3d& line, double angle) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(angle, line.direction()).toRotationMatrix();
  turn.translation() = line.origin() - turn.linear() * line.origin();
  return turn;
}

/// The line moved by tilts about the two directions across it and by shifts along them.
Line3d movedLine(const Line3d& line, const Eigen::Vector4d& by) {
  const Eigen::Vector3d u = line.direction().unitOrthogonal(), v = line.direction().cross(u);
  return {line.origin() + by[2] * u + by[3] * v, (line.direction() + by[0] * u + by[1] * v).normalized()};
}

}  // namespace

TurnEvidence::TurnEvidence(const NormalizedCloud& cloud, double tolerance, std::uint64_t seed)
    : cloud_(cloud),
      tolerance_(tolerance),
      viewpoint_(cloud.visibility->viewpoint()),
      far_(kFarTurn * tolerance),
      reach_(kSlackOfReach * (far_ + greatestDisc(cloud.geometry))),
      samples_(drawSamples(cloud.points.cols(), kSamplesOfTurn, seed)),
      few_samples_(drawSamples(cloud.points.cols(), kFewSamplesOfTurn, seed)) {}

bool TurnEvidence::isSeenEmpty(const Eigen::Vector3d& x) const {
  const Visibility& visibility = *cloud_.visibility;
  if (visibility.depthBehind(x) >= -tolerance_) return false;
  // The rim of what was seen is as exact as its pixels.
  const Eigen::Vector3d ray = (x - viewpoint_).normalized(), u = ray.unitOrthogonal(), v = ray.cross(u);
  for (const Eigen::Vector3d& aside : {u, v, Eigen::Vector3d(-u), Eigen::Vector3d(-v)})
    if (visibility.depthBehind(x + std::max(tolerance_, cloud_.spacing) * aside) >= -tolerance_) return false;
  return true;
}

TurnShares TurnEvidence::roughly(const Line3d& line, double angle, double slack, double most_off,
                                 double most_far) const {
  const Eigen::Isometry3d turn = turnAbout(line, angle);
  TurnShares shares;
  const double one = 1.0 / static_cast<double>(few_samples_.size());
  for (const int sample : few_samples_) {
    if (shares.off > most_off || shares.far > most_far) break;
    const Eigen::Vector3d x = turn * cloud_.points.col(sample).cast<double>();
    const double f = std::max(kLeastTurnF, cloud_.edt(x * cloud_.scale + cloud_.center));
    const double distance = cloud_.sigma * std::sqrt(std::max(0.0, -std::log(f)));
    if (distance <= slack * tolerance_) {
      shares.on += one;
    } else if (isSeenEmpty(x)) {
      shares.off += one;
      shares.far += distance > far_ ? one : 0.0;
    }
  }
  return shares;
}

TurnShares TurnEvidence::exactly(const Line3d& line, double angle) const {
  const Eigen::Isometry3d turn = turnAbout(line, angle);
  Points turned(3, static_cast<Eigen::Index>(samples_.size()));
  for (std::size_t i = 0; i < samples_.size(); ++i)
    turned.col(static_cast<Eigen::Index>(i)) = (turn * cloud_.points.col(samples_[i]).cast<double>()).cast<float>();
  // Of points beyond the reach nothing is asked but that they are far.
  std::vector<int> closest(samples_.size(), -1);
  std::vector<float> sq_distances;
  cloud_.search->searchWithin(turned, static_cast<float>(reach_ * reach_), closest, sq_distances);
  const std::vector<float> distances = surfaceDistances(turned, closest, cloud_.points, cloud_.geometry);
  TurnShares shares;
  const double one = 1.0 / static_cast<double>(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const double distance = std::min(distances[i], std::sqrt(sq_distances[i]));
    if (distance <= tolerance_) {
      shares.on += one;
    } else if (isSeenEmpty(turned.col(static_cast<Eigen::Index>(i)).cast<double>())) {
      shares.off += one;
      shares.far += distance > far_ ? one : 0.0;
    }
  }
  return shares;
}

Line3d TurnEvidence::refined(const Line3d& start, const std::vector<double>& angles) const {
  // Tilts about the point of the line among the points, so that they and the shifts are independent.
  Line3d line(start.projection(Eigen::Vector3d::Zero()), start.direction());
  Points turned(3, static_cast<Eigen::Index>(few_samples_.size()));
  std::vector<int> closest;
  std::vector<float> sq_distances;
  for (const double width : kFitWidths) {
    const double sq_width = width * width * tolerance_ * tolerance_;
    Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    for (const double angle : angles) {
      const Eigen::Isometry3d turn = turnAbout(line, angle);
      std::array<Eigen::Isometry3d, 4> beside;
      for (int k = 0; k < 4; ++k) beside[k] = turnAbout(movedLine(line, kFitStep * Eigen::Vector4d::Unit(k)), angle);
      for (std::size_t i = 0; i < few_samples_.size(); ++i)
        turned.col(static_cast<Eigen::Index>(i)) =
            (turn * cloud_.points.col(few_samples_[i]).cast<double>()).cast<float>();
      closest.assign(few_samples_.size(), -1);
      cloud_.search->searchWithin(turned, static_cast<float>(kFitReach * kFitReach * sq_width), closest, sq_distances);
      for (std::size_t i = 0; i < few_samples_.size(); ++i) {
        if (closest[i] < 0 || cloud_.geometry.at_border[closest[i]]) continue;
        const Eigen::Vector3d x = cloud_.points.col(few_samples_[i]).cast<double>(), y = turn * x;
        const Eigen::Vector3d normal = cloud_.geometry.normals.col(closest[i]).cast<double>();
        Eigen::Vector4d slope;
        for (int k = 0; k < 4; ++k) slope[k] = normal.dot(beside[k] * x - y) / kFitStep;
        const double miss = normal.dot(y - cloud_.points.col(closest[i]).cast<double>());
        const double weight = std::exp(-sq_distances[i] / sq_width);
        squares += weight * slope * slope.transpose();
        pull -= weight * miss * slope;
      }
    }
    squares.diagonal().array() += kFitRidge * squares.trace() + kLeastTurnF;
    const Eigen::Vector4d step = squares.ldlt().solve(pull);
    constexpr double kMostStep = 0.1;  // radians, radii; chosen: starts are closer, larger steps leave the basin
    line = movedLine(line, step * std::min(1.0, kMostStep / std::max(kFitStep, step.norm())));
    line.origin() = line.projection(Eigen::Vector3d::Zero());
  }
  return line;
}

}  // namespace pcl_symmetry
