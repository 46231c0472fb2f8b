#include "core/matching/view_signature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
#include "core/geometry/point_samples.h"
#include "core/matching/matching_rules.h"

namespace pcl_symmetry {

namespace {

/// Points by coordinates, N x 3: all x, then all y, then all z.
using PointColumns = Eigen::Matrix<float, Eigen::Dynamic, 3>;

/// Points seen from far away: the nearest depth in each cell of a square raster. The viewer looks along z.
class DepthRaster {
public:
  /// Depth of a cell without a point.
  static constexpr float kBackground = std::numeric_limits<float>::infinity();

  /// \param side cells along each side, >= 1.
  /// \param corner least x and y of the raster.
  /// \param cell width of a cell, > 0, units of the points.
  DepthRaster(int side, const Eigen::Array2f& corner, float cell)
      : side_(side), corner_(corner), cell_(cell), depths_(static_cast<std::size_t>(side) * side, kBackground) {}

  /// Points beyond the raster are left out.
  void add(const PointColumns& points) {
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const float u = (points(i, 0) - corner_.x()) / cell_, v = (points(i, 1) - corner_.y()) / cell_;
      const auto side = static_cast<float>(side_);
      if (!(u >= 0.0f && v >= 0.0f && u < side && v < side)) continue;
      float& depth = depths_[static_cast<int>(v) * side_ + static_cast<int>(u)];
      depth = std::min(depth, points(i, 2));
    }
  }

  int side() const { return side_; }
  Eigen::Array2f center(int u, int v) const { return corner_ + cell_ * (Eigen::Array2i(u, v).cast<float>() + 0.5f); }
  /// \return kBackground also beyond the raster.
  float depth(int u, int v) const {
    const bool inside = u >= 0 && v >= 0 && u < side_ && v < side_;
    return inside ? depths_[v * side_ + u] : kBackground;
  }

private:
  int side_;
  Eigen::Array2f corner_;
  float cell_;
  std::vector<float> depths_;  // x fastest
};

/// The outline of the visible part.
struct ViewOutline {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< mean of the cells inside the outline, and of their depths
  double radius = 0.0;  ///< root mean square distance of the inside from the middle, in the raster
};

/// A raster smoothed over neighboring cells, sampled between their centers.
class SmoothRaster {
public:
  /// \param middle depth that becomes 0.
  /// \param unit unit of depths, > 0.
  SmoothRaster(const DepthRaster& raster, float middle, float unit) : side_(raster.side()) {
    const float weights[3] = {0.25f, 0.5f, 0.25f};
    const float deepest = kMatching.deepest;
    values_.resize(static_cast<std::size_t>(side_) * side_);
    for (int v = 0; v < side_; ++v) {
      for (int u = 0; u < side_; ++u) {
        Eigen::Array2f& value = values_[v * side_ + u];
        value.setZero();
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) {
            const float depth = raster.depth(u + i, v + j);
            if (depth == DepthRaster::kBackground) continue;
            value += weights[i + 1] * weights[j + 1] *
                     Eigen::Array2f(1.0f, std::clamp((depth - middle) / unit, -deepest, deepest));
          }
        }
      }
    }
  }

  /// \param at position in cells from the corner.
  /// \return outline (1 inside) and depth, both 0 beyond the raster.
  Eigen::Array2f sample(const Eigen::Array2f& at) const {
    const Eigen::Array2f corner = (at - 0.5f).floor(), t = at - 0.5f - corner;
    const int u = static_cast<int>(corner.x()), v = static_cast<int>(corner.y());
    return (1.0f - t.y()) * ((1.0f - t.x()) * value(u, v) + t.x() * value(u + 1, v)) +
           t.y() * ((1.0f - t.x()) * value(u, v + 1) + t.x() * value(u + 1, v + 1));
  }

private:
  Eigen::Array2f value(int u, int v) const {
    if (u < 0 || v < 0 || u >= side_ || v >= side_) return Eigen::Array2f::Zero();
    return values_[v * side_ + u];
  }

  int side_;
  std::vector<Eigen::Array2f> values_;
};

template <typename Visit>
void forEachSeenCell(const DepthRaster& raster, const Visit& visit) {
  for (int v = 0; v < raster.side(); ++v) {
    for (int u = 0; u < raster.side(); ++u) {
      const float depth = raster.depth(u, v);
      if (depth != DepthRaster::kBackground) visit(raster.center(u, v).cast<double>().matrix(), depth);
    }
  }
}

/// \param in_view N >= 1 points, z away from the viewer.
/// \throws std::invalid_argument for points that are seen as one.
ViewOutline outlineOf(const PointColumns& in_view) {
  const Eigen::Array2f low = in_view.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Array2f high = in_view.leftCols<2>().colwise().maxCoeff().transpose();
  const float extent = (high - low).maxCoeff();
  check(extent > 0.0f, "extent of the points across the view", extent, "> 0");
  const int cells = kMatching.outline_cells;
  DepthRaster raster(cells + 1, low, extent / cells);
  raster.add(in_view);

  ViewOutline outline;
  double count = 0.0, sq_radius = 0.0;
  forEachSeenCell(raster, [&](const Eigen::Vector2d& at, float depth) {
    outline.middle += Eigen::Vector3d(at.x(), at.y(), depth);
    count += 1.0;
  });
  outline.middle /= count;
  forEachSeenCell(
      raster, [&](const Eigen::Vector2d& at, float) { sq_radius += (at - outline.middle.head<2>()).squaredNorm(); });
  // The mean square distance from the center of a square cell is 1/6 of its squared side.
  outline.radius = std::sqrt(sq_radius / count + extent * extent / (6.0 * cells * cells));
  return outline;
}

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

/// View::values of a raster.
Eigen::VectorXf harmonicsOf(const SmoothRaster& raster) {
  Eigen::VectorXf values = Eigen::VectorXf::Zero(kViewSignatureSize);
  const float reach = kMatching.raster_reach, to_cells = kMatching.raster_cells / (2.0f * reach);
  for (int ring = 0; ring < kViewRings; ++ring) {
    const double radius = (ring + 0.5) * kMatching.outer_ring / kViewRings;
    for (int a = 0; a < kNumAngles; ++a) {
      const float x = static_cast<float>(radius) * rotationTable().cosines[1][a],
                  y = static_cast<float>(radius) * rotationTable().sines[1][a];
      const Eigen::Array2f sample = raster.sample((Eigen::Array2f(x, y) + reach) * to_cells);
      for (int m = 0; m <= kViewHarmonics; ++m) {
        // A ring is weighted by its area; a harmonic and its conjugate count as two.
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

/// Points to be viewed from many sides, in radii of their bounding ball.
class ViewedPoints {
public:
  explicit ViewedPoints(const PointsRef& points)
      : ball_(checkedBall(points)), points_(normalizePoints(points, ball_.center, ball_.radius).transpose()) {}

  View from(const Eigen::Vector3d& forward) const {
    const Eigen::Matrix3d R_view_input = viewingFrame(forward.normalized());
    const PointColumns in_view = points_.lazyProduct(R_view_input.cast<float>().transpose().eval());
    const ViewOutline outline = outlineOf(in_view);
    const Eigen::Vector3f middle = outline.middle.cast<float>();
    const auto radius = static_cast<float>(outline.radius);
    const float reach = kMatching.raster_reach;
    const int cells = kMatching.raster_cells;
    DepthRaster raster(cells, middle.head<2>().array() - reach * radius, 2.0f * reach * radius / cells);
    raster.add(in_view);
    View view;
    view.values = harmonicsOf(SmoothRaster(raster, middle.z(), radius));
    view.radius = outline.radius * ball_.radius;
    view.T_view_input.linear() = R_view_input;
    view.T_view_input.translation() = -(R_view_input * ball_.center + ball_.radius * outline.middle);
    return view;
  }

private:
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
  if (apart >= enough) return best;  // the distance of the magnitudes is the smaller of the two
  // Above this distance of the signatures, the remaining terms are not needed.
  const float enough_of_all = (enough - weight * apart) / (1.0f - weight);
  // Re conj(V_m) Q_m exp(i m a) is what harmonic m adds to the correlation with the view rotated by a.
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
  const float min_correlation = 1.0f - 0.5f * enough_of_all * enough_of_all;
  if (greatest <= min_correlation) return best;
  std::array<float, kNumAngles> correlation;
  correlation.fill(real[0]);
  for (int m = 1; m <= kViewHarmonics; ++m)
    for (int a = 0; a < kNumAngles; ++a)
      correlation[a] += real[m] * rotationTable().cosines[m][a] - imaginary[m] * rotationTable().sines[m][a];
  const auto at = std::max_element(correlation.begin(), correlation.end());
  if (*at <= min_correlation) return best;
  best.distance = weight * apart + (1.0f - weight) * std::sqrt(std::max(0.0f, 2.0f - 2.0f * *at));
  best.angle = -2.0 * kPi * static_cast<double>(at - correlation.begin()) / kNumAngles;
  return best;
}

Eigen::Isometry3d poseOfView(const View& scan, const View& model, double angle) {
  return model.T_view_input.inverse() * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * scan.T_view_input;
}

}  // namespace pcl_symmetry
