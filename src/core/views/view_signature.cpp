#include "core/views/view_signature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/geometry/directions.h"
#include "pcl_symmetry/core/viewpoint/viewpoint_score.h"

namespace pcl_symmetry {

namespace {

constexpr int kOutlineCells = 48;  // across the larger side of the outline, to find its middle and radius
constexpr int kPictureCells = 32;  // across the picture
constexpr float kReach = 2.5f;     // half the side of the picture, in radii of the outline
constexpr double kOuterRing = 2.3;
constexpr int kNumAngles = 48;        // of samples on a ring, and of turns
constexpr float kDeepest = 2.0f;      // radii: a depth farther from the mean counts as this
constexpr int kRow = 2 * kViewRings;  // values of a harmonic's real or imaginary part
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Cosines and sines of m times the angle of each turn.
struct Turns {
  std::array<std::array<float, kNumAngles>, kViewHarmonics + 1> cosines, sines;
};

const Turns& turns() {
  static const Turns values = [] {
    Turns made;
    for (int m = 0; m <= kViewHarmonics; ++m) {
      for (int a = 0; a < kNumAngles; ++a) {
        made.cosines[m][a] = static_cast<float>(std::cos(2.0 * M_PI * m * a / kNumAngles));
        made.sines[m][a] = static_cast<float>(std::sin(2.0 * M_PI * m * a / kNumAngles));
      }
    }
    return made;
  }();
  return values;
}

/// The nearest depth in each cell of a square picture.
class DepthPicture {
public:
  DepthPicture(int side, const Eigen::Array2f& corner, float cell)
      : side_(side), corner_(corner), cell_(cell), depths_(static_cast<std::size_t>(side) * side, kNothing) {}

  void add(const Eigen::Vector3f& x) {
    const Eigen::Array2i at = ((x.head<2>().array() - corner_) / cell_).floor().cast<int>();
    if ((at < 0).any() || (at >= side_).any()) return;
    float& depth = depths_[static_cast<std::size_t>(at.y() * side_ + at.x())];
    depth = std::min(depth, x.z());
  }

  int side() const { return side_; }
  Eigen::Array2f center(int u, int v) const { return corner_ + cell_ * (Eigen::Array2i(u, v).cast<float>() + 0.5f); }
  /// Infinity where nothing is seen, also beyond the picture.
  float depth(int u, int v) const {
    const bool inside = u >= 0 && v >= 0 && u < side_ && v < side_;
    return inside ? depths_[static_cast<std::size_t>(v * side_ + u)] : kNothing;
  }

private:
  int side_;
  Eigen::Array2f corner_;
  float cell_;
  std::vector<float> depths_;
};

/// The middle of what is seen, and the radius of its outline.
struct Outline {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

Outline outlineOf(const Points& in_view) {
  const Eigen::Array2f low = in_view.topRows<2>().rowwise().minCoeff();
  const Eigen::Array2f high = in_view.topRows<2>().rowwise().maxCoeff();
  const float extent = (high - low).maxCoeff();
  check(extent > 0.0f, "extent of the points across the view", extent, "> 0");
  DepthPicture picture(kOutlineCells + 1, low, extent / kOutlineCells);
  for (Eigen::Index i = 0; i < in_view.cols(); ++i) picture.add(in_view.col(i));
  Outline outline;
  double count = 0.0, sq_radius = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int v = 0; v < picture.side(); ++v) {
      for (int u = 0; u < picture.side(); ++u) {
        if (picture.depth(u, v) == kNothing) continue;
        const Eigen::Vector2d at = picture.center(u, v).cast<double>();
        if (pass == 0) {
          outline.middle += Eigen::Vector3d(at.x(), at.y(), picture.depth(u, v));
          count += 1.0;
        } else {
          sq_radius += (at - outline.middle.head<2>()).squaredNorm();
        }
      }
    }
    if (pass == 0) outline.middle /= count;
  }
  // A cell has an extent of its own.
  outline.radius = std::sqrt(sq_radius / count + extent * extent / (6.0 * kOutlineCells * kOutlineCells));
  return outline;
}

/// Outline (1 inside) and depth of each cell, smoothed over its neighbours; sampled between cells.
class SmoothPicture {
public:
  explicit SmoothPicture(const DepthPicture& picture) : side_(picture.side()) {
    constexpr float kWeights[3] = {0.25f, 0.5f, 0.25f};
    values_.resize(static_cast<std::size_t>(side_) * side_);
    for (int v = 0; v < side_; ++v) {
      for (int u = 0; u < side_; ++u) {
        Eigen::Array2f& value = values_[static_cast<std::size_t>(v * side_ + u)];
        value.setZero();
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i) {
            const float depth = picture.depth(u + i, v + j);
            if (depth == kNothing) continue;
            value += kWeights[i + 1] * kWeights[j + 1] * Eigen::Array2f(1.0f, std::clamp(depth, -kDeepest, kDeepest));
          }
        }
      }
    }
  }

  /// \param at in cells from the corner.
  Eigen::Array2f sample(const Eigen::Array2f& at) const {
    const Eigen::Array2f corner = (at - 0.5f).floor(), t = at - 0.5f - corner;
    const int u = static_cast<int>(corner.x()), v = static_cast<int>(corner.y());
    return (1.0f - t.y()) * ((1.0f - t.x()) * value(u, v) + t.x() * value(u + 1, v)) +
           t.y() * ((1.0f - t.x()) * value(u, v + 1) + t.x() * value(u + 1, v + 1));
  }

private:
  Eigen::Array2f value(int u, int v) const {
    if (u < 0 || v < 0 || u >= side_ || v >= side_) return Eigen::Array2f::Zero();
    return values_[static_cast<std::size_t>(v * side_ + u)];
  }

  int side_;
  std::vector<Eigen::Array2f> values_;
};

/// Where the parts of a harmonic begin.
int realPart(int harmonic) {
  return harmonic == 0 ? 0 : kRow * (2 * harmonic - 1);
}
int imaginaryPart(int harmonic) {
  return kRow * 2 * harmonic;
}

Eigen::VectorXf harmonicsOf(const SmoothPicture& picture) {
  Eigen::VectorXf values = Eigen::VectorXf::Zero(kViewSignatureSize);
  const float to_cells = kPictureCells / (2.0f * kReach);
  for (int ring = 0; ring < kViewRings; ++ring) {
    const double radius = (ring + 0.5) * kOuterRing / kViewRings;
    for (int a = 0; a < kNumAngles; ++a) {
      const float x = static_cast<float>(radius) * turns().cosines[1][a],
                  y = static_cast<float>(radius) * turns().sines[1][a];
      const Eigen::Array2f sample = picture.sample((Eigen::Array2f(x, y) + kReach) * to_cells);
      for (int m = 0; m <= kViewHarmonics; ++m) {
        // Rings count as their area, pairs of conjugate harmonics as two.
        const float weight = static_cast<float>(std::sqrt((m > 0 ? 2.0 : 1.0) * radius));
        for (int c = 0; c < 2; ++c) {
          values[realPart(m) + c * kViewRings + ring] += weight * turns().cosines[m][a] * sample[c];
          if (m > 0) values[imaginaryPart(m) + c * kViewRings + ring] -= weight * turns().sines[m][a] * sample[c];
        }
      }
    }
  }
  const float norm = values.norm();
  if (norm > 0.0f) values /= norm;
  return values;
}

/// Points in radii about their middle, so that no unit is too small or too large for squares.
class Viewed {
public:
  explicit Viewed(const PointsRef& points) : ball_(boundingBallOf(points)) {
    check(ball_.radius > 0.0, "radius of the points", ball_.radius, "> 0");
    points_ = normalizePoints(points, ball_.center, ball_.radius);
  }

  View from(const Eigen::Vector3d& forward) const {
    Eigen::Matrix3d R_view_input;
    R_view_input.row(2) = forward.normalized();
    R_view_input.row(0) = R_view_input.row(2).unitOrthogonal();
    R_view_input.row(1) = R_view_input.row(2).cross(R_view_input.row(0));
    Points in_view = R_view_input.cast<float>() * points_;
    const Outline outline = outlineOf(in_view);
    in_view = normalizePoints(in_view, outline.middle, outline.radius);
    DepthPicture picture(kPictureCells, Eigen::Array2f::Constant(-kReach), 2.0f * kReach / kPictureCells);
    for (Eigen::Index i = 0; i < in_view.cols(); ++i) picture.add(in_view.col(i));
    View view;
    view.values = harmonicsOf(SmoothPicture(picture));
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
  Points points_;
};

float dot(const float* a, const float* b) {
  float sum = 0.0f;
  for (int i = 0; i < kRow; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

View viewOf(const PointsRef& points, const Eigen::Vector3d& forward) {
  check(forward.allFinite() && forward.norm() > 0.0, "length of the direction", forward.norm(), "finite and > 0");
  return Viewed(points).from(forward);
}

std::vector<View> viewsAround(const PointsRef& points, int num_views, int num_threads) {
  check(num_views >= 1, "num_views", num_views, ">= 1");
  const std::vector<Eigen::Vector3d> directions = evenDirections(num_views);
  const Viewed viewed(points);
  std::vector<View> views(directions.size());
  parallelBlocks(views.size(), num_threads, [&](std::size_t i) { views[i] = viewed.from(directions[i]); });
  return views;
}

ViewComparison::ViewComparison(const View& view) : values_(view.values) {}

ViewAgreement ViewComparison::compare(const float* values, float enough) const {
  // Re conj(V_m) Q_m exp(i m a) is the share of harmonic m in the correlation with the picture turned by a.
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
  ViewAgreement best;
  const float least = 1.0f - 0.5f * enough * enough;
  if (greatest <= least) return best;
  std::array<float, kNumAngles> correlation;
  correlation.fill(real[0]);
  for (int m = 1; m <= kViewHarmonics; ++m)
    for (int a = 0; a < kNumAngles; ++a)
      correlation[a] += real[m] * turns().cosines[m][a] - imaginary[m] * turns().sines[m][a];
  const auto at = std::max_element(correlation.begin(), correlation.end());
  if (*at <= least) return best;
  best.distance = std::sqrt(std::max(0.0f, 2.0f - 2.0f * *at));
  best.turn = -2.0 * M_PI * static_cast<double>(at - correlation.begin()) / kNumAngles;
  return best;
}

Eigen::Isometry3d poseOfView(const View& scan, const View& model, double turn) {
  return model.T_view_input.inverse() * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * scan.T_view_input;
}

}  // namespace pcl_symmetry
