#include "core/matching/view_signature.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
#include "core/geometry/viewing_frame.h"
#include "core/matching/depth_picture.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

constexpr int kNumAngles = 48;        // samples on a ring, and rotations that are compared: 7.5 degrees
constexpr int kRow = 2 * kViewRings;  // values of the real or imaginary part of a harmonic: outline and depth

/// Cosines and sines of m times the angle of each rotation.
struct RotationTable {
  std::array<std::array<float, kNumAngles>, kViewHarmonics + 1> cosines, sines;
};

const RotationTable& rotationTable() {
  static const RotationTable values = [] {
    RotationTable made;
    for (int m = 0; m <= kViewHarmonics; ++m) {
      for (int a = 0; a < kNumAngles; ++a) {
        made.cosines[m][a] = static_cast<float>(std::cos(2.0 * kPi * m * a / kNumAngles));
        made.sines[m][a] = static_cast<float>(std::sin(2.0 * kPi * m * a / kNumAngles));
      }
    }
    return made;
  }();
  return values;
}

/// Indices where the parts of a harmonic begin, see View::values.
int realPart(int harmonic) {
  return harmonic == 0 ? 0 : kRow * (2 * harmonic - 1);
}
int imaginaryPart(int harmonic) {
  return kRow * 2 * harmonic;
}

/// View::values of a picture.
Eigen::VectorXf harmonicsOf(const SmoothPicture& picture) {
  Eigen::VectorXf values = Eigen::VectorXf::Zero(kViewSignatureSize);
  const float reach = kMatching.picture_reach, to_cells = kMatching.picture_cells / (2.0f * reach);
  for (int ring = 0; ring < kViewRings; ++ring) {
    const double radius = (ring + 0.5) * kMatching.outer_ring / kViewRings;
    for (int a = 0; a < kNumAngles; ++a) {
      const float x = static_cast<float>(radius) * rotationTable().cosines[1][a],
                  y = static_cast<float>(radius) * rotationTable().sines[1][a];
      const Eigen::Array2f sample = picture.sample((Eigen::Array2f(x, y) + reach) * to_cells);
      for (int m = 0; m <= kViewHarmonics; ++m) {
        // A ring counts by its area; a harmonic and its conjugate count as two.
        const float weight = static_cast<float>(std::sqrt((m > 0 ? 2.0 : 1.0) * radius));
        for (int c = 0; c < 2; ++c) {
          values[realPart(m) + c * kViewRings + ring] += weight * rotationTable().cosines[m][a] * sample[c];
          if (m > 0)
            values[imaginaryPart(m) + c * kViewRings + ring] -= weight * rotationTable().sines[m][a] * sample[c];
        }
      }
    }
  }
  const float norm = values.norm();
  if (norm > 0.0f) values /= norm;
  return values;
}

/// Points that are looked at from many sides, in radii of their bounding ball: squares neither overflow nor underflow.
class ViewedPoints {
public:
  explicit ViewedPoints(const PointsRef& points) : ball_(boundingBallOf(points)) {
    check(ball_.radius > 0.0, "radius of the points", ball_.radius, "> 0");
    points_ = normalizePoints(points, ball_.center, ball_.radius).transpose();
  }

  View from(const Eigen::Vector3d& forward) const {
    const Eigen::Matrix3d R_view_input = viewingFrame(forward.normalized());
    const PointColumns in_view = points_.lazyProduct(R_view_input.cast<float>().transpose().eval());
    const ViewOutline outline = outlineOf(in_view);
    const Eigen::Vector3f middle = outline.middle.cast<float>();
    const auto radius = static_cast<float>(outline.radius);
    const float reach = kMatching.picture_reach;
    const int cells = kMatching.picture_cells;
    DepthPicture picture(cells, middle.head<2>().array() - reach * radius, 2.0f * reach * radius / cells);
    picture.add(in_view);
    View view;
    view.values = harmonicsOf(SmoothPicture(picture, middle.z(), radius));
    view.radius = outline.radius * ball_.radius;
    view.T_view_input.linear() = R_view_input;
    view.T_view_input.translation() = -(R_view_input * ball_.center + ball_.radius * outline.middle);
    return view;
  }

private:
  static BoundingBall boundingBallOf(const PointsRef& points) {
    if (points.cols() == 0) throw std::invalid_argument("points: 0 given, must be >= 1");
    if (!points.allFinite()) throw std::invalid_argument("points: a coordinate is not finite");
    return boundingBall(points);
  }

  BoundingBall ball_;
  PointColumns points_;
};

/// Inner product of one part of two harmonics.
float dot(const float* a, const float* b) {
  float sum = 0.0f;
  for (int i = 0; i < kRow; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

View viewOf(const PointsRef& points, const Eigen::Vector3d& forward) {
  check(forward.allFinite() && forward.norm() > 0.0, "length of the direction", forward.norm(), "finite and > 0");
  return ViewedPoints(points).from(forward);
}

std::vector<View> viewsAround(const PointsRef& points, int num_views, int num_threads) {
  check(num_views >= 1, "num_views", num_views, ">= 1");
  const std::vector<Eigen::Vector3d> directions = evenDirections(num_views);
  const ViewedPoints viewed(points);
  std::vector<View> views(directions.size());
  parallelBlocks(views.size(), num_threads, [&](std::size_t i) { views[i] = viewed.from(directions[i]); });
  return views;
}

Eigen::VectorXf magnitudesOf(const Eigen::VectorXf& values) {
  Eigen::VectorXf magnitudes(kViewMagnitudes);
  magnitudes.head<kRow>() = values.head<kRow>();
  for (int m = 1; m <= kViewHarmonics; ++m)
    magnitudes.segment<kRow>(kRow * m) =
        (values.segment<kRow>(realPart(m)).array().square() + values.segment<kRow>(imaginaryPart(m)).array().square())
            .sqrt();
  return magnitudes;
}

ViewComparison::ViewComparison(const View& view) : values_(view.values), magnitudes_(magnitudesOf(view.values)) {}

ViewAgreement ViewComparison::compare(const float* values, float enough) const {
  ViewAgreement best;
  const float weight = kMatching.magnitude_weight;
  const Eigen::Map<const Eigen::VectorXf> other(values, kViewSignatureSize);
  const float apart = (magnitudesOf(other) - magnitudes_).norm();
  if (apart >= enough) return best;  // it is the smaller one of the two distances
  // From this distance of the signatures on, what is left is not needed.
  const float enough_of_all = (enough - weight * apart) / (1.0f - weight);
  // Re conj(V_m) Q_m exp(i m a) is what harmonic m adds to the correlation with the picture rotated by a.
  const float* own = values_.data();
  std::array<float, kViewHarmonics + 1> real, imaginary;
  real[0] = dot(values, own);
  float greatest = real[0];
  for (int m = 1; m <= kViewHarmonics; ++m) {
    const float *vr = values + realPart(m), *vi = values + imaginaryPart(m);
    const float *qr = own + realPart(m), *qi = own + imaginaryPart(m);
    real[m] = dot(vr, qr) + dot(vi, qi);
    imaginary[m] = dot(vr, qi) - dot(vi, qr);
    greatest += std::sqrt(real[m] * real[m] + imaginary[m] * imaginary[m]);
  }
  const float least = 1.0f - 0.5f * enough_of_all * enough_of_all;
  if (greatest <= least) return best;
  std::array<float, kNumAngles> correlation;
  correlation.fill(real[0]);
  for (int m = 1; m <= kViewHarmonics; ++m)
    for (int a = 0; a < kNumAngles; ++a)
      correlation[a] += real[m] * rotationTable().cosines[m][a] - imaginary[m] * rotationTable().sines[m][a];
  const auto at = std::max_element(correlation.begin(), correlation.end());
  if (*at <= least) return best;
  best.distance = weight * apart + (1.0f - weight) * std::sqrt(std::max(0.0f, 2.0f - 2.0f * *at));
  best.angle = -2.0 * kPi * static_cast<double>(at - correlation.begin()) / kNumAngles;
  return best;
}

Eigen::Isometry3d poseOfView(const View& scan, const View& model, double angle) {
  return model.T_view_input.inverse() * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * scan.T_view_input;
}

}  // namespace pcl_symmetry
