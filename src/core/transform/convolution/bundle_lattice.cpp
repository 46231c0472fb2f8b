#include "core/transform/convolution/bundle_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/simd.h"
#include "core/distance_transform/lookup_table.h"

namespace pcl_symmetry {

namespace {

// Lines of a bundle may be farther apart by this than what was asked for, where rows are the closer. derived: two whole
// cells in place of 0.9 sigmas of two cells.
constexpr double kMostStretch = 1.12;
constexpr float kLeastSlope = 1e-5f;  // derived: along 4096 cells a slab is left by less than half a cell

/// Where bundles with their middles at x enter the last slab and leave the first one.
PCL_SYMMETRY_MULTIVERSION
void cutAtSlabs(const float* entry, const float* exit, const float* of_x, const float* x, float* first, float* last) {
  typedef float Lanes __attribute__((vector_size(4 * kBundleLanes)));
  Lanes middle, low, high;
  std::memcpy(&middle, x, sizeof middle);
  low = entry[0] - middle * of_x[0];
  high = exit[0] - middle * of_x[0];
  for (int k = 1; k < kMostSlabs; ++k) {
    const Lanes moved = middle * of_x[k];
    const Lanes entered = entry[k] - moved, left = exit[k] - moved;
    low = low < entered ? entered : low;
    high = left < high ? left : high;
  }
  std::memcpy(first, &low, sizeof low);
  std::memcpy(last, &high, sizeof high);
}

}  // namespace

BundleLattice::BundleLattice(const GaussianEdt& edt, const PlaneGrid& grid, double spacing_in_sigmas) : slabs(edt) {
  middle = 0.5 * (edt.numCells() - 1);
  clip = middle - 0.5;
  center = ((grid.center() - edt.origin()) / edt.cellSize()).array() - middle;
  grid_offset = grid.offset(0) / edt.cellSize();
  radius_step = grid.radiusStep() / edt.cellSize();
  spacing = spacing_in_sigmas * edt.sigma() / edt.cellSize();
  step = std::max(1, static_cast<int>(kMostStretch * spacing));
  refine = static_cast<int>(std::ceil(2.0 * radius_step / spacing));
  along = 2.0 * radius_step / refine;
  most_ahead = half() / std::sqrt(3.0);  // the axis that is the farthest from n has at most 1 / sqrt(3) of it
  num_along = static_cast<int>(std::ceil(2.0 * (clip + most_ahead + radius_step) / along)) + 2;
}

BundlesOfDirection::BundlesOfDirection(const BundleLattice& lattice, const Eigen::Vector3d& normal)
    : lattice_(lattice) {
  normal.cwiseAbs().minCoeff(&axis_);
  n_ = {normal[axis_], normal[(axis_ + 1) % 3], normal[(axis_ + 2) % 3]};
  across_ = std::hypot(n_.y(), n_.z());
  v_ = Eigen::Vector3d(0.0, -n_.z(), n_.y()) / across_;
  between_ = std::min(lattice.spacing, lattice.spacing * lattice.spacing / (lattice.step * across_));
  const double first_offset = normal.dot(lattice.center) + lattice.grid_offset;
  num_skipped_ = std::floor((-lattice.clip - lattice.most_ahead - first_offset) / lattice.radius_step);
  t0_ = first_offset + num_skipped_ * lattice.radius_step;
  for (int i = 0; i < 3; ++i) step_[i] = LookupTable::toFixed(lattice.along * n_[i]);
  setSlabs();
}

void BundlesOfDirection::setSlabs() {
  const Eigen::Vector3f n = n_.cast<float>(), v = v_.cast<float>();
  for (int k = 0; k < kMostSlabs; ++k) {
    const auto all = lattice_.slabs.axes.row(k);
    const Eigen::Vector3f w(all[axis_], all[(axis_ + 1) % 3], all[(axis_ + 2) % 3]);
    const float slope = std::copysign(std::max(std::abs(w.dot(n)), kLeastSlope), w.dot(n));
    const float middle = w.sum() * static_cast<float>(lattice_.middle);
    const float reach = std::abs(w.x()) * static_cast<float>(lattice_.half());
    // Cells beyond the ball are 0 as well.
    const float ball = static_cast<float>(lattice_.clip) * w.norm() + 0.5f * w.lpNorm<1>();
    const float low = std::max(lattice_.slabs.low[k] - middle, -ball) - reach;
    const float high = std::min(lattice_.slabs.high[k] - middle, ball) + reach;
    entry_[k] = (slope > 0.0f ? low : high) / slope;
    exit_[k] = (slope > 0.0f ? high : low) / slope;
    of_b_[k] = w.dot(v) / slope;
    of_x_[k] = w.x() / slope;
  }
}

int BundlesOfDirection::numRows() const {
  return static_cast<int>(std::ceil(lattice_.clip / between_));
}

void BundlesOfDirection::addRow(double b, double shift, std::vector<Bundle>& bundles) const {
  if (std::abs(b) >= lattice_.clip) return;
  // The ball casts an ellipse along n. Rows are shifted by up to half a step.
  const double width = kBundleLanes * lattice_.step;
  const int num_side = static_cast<int>(std::ceil(lattice_.clip / (across_ * width) + 0.5 / kBundleLanes));
  float entry[kMostSlabs], exit[kMostSlabs];
  for (int k = 0; k < kMostSlabs; ++k) {
    entry[k] = entry_[k] - static_cast<float>(b) * of_b_[k];
    exit[k] = exit_[k] - static_cast<float>(b) * of_b_[k];
  }
  const auto scale = static_cast<float>(1.0 / lattice_.along);
  for (int c = -num_side; c < num_side; c += kBundleLanes) {
    // Ends of kBundleLanes bundles at a time.
    float middles[kBundleLanes], first[kBundleLanes], last[kBundleLanes];
    for (int i = 0; i < kBundleLanes; ++i) middles[i] = static_cast<float>((c + i + 0.5) * width + shift);
    cutAtSlabs(entry, exit, of_x_, middles, first, last);
    for (int i = 0; i < std::min(kBundleLanes, num_side - c); ++i) {
      const double x = middles[i];
      const double from = t0_ - x * n_.x();  // tau of point 0
      Bundle bundle;
      const float after_first = (first[i] - static_cast<float>(from)) * scale;
      const float after_last = (last[i] - static_cast<float>(from)) * scale;
      bundle.first = static_cast<int>(std::max(0.0f, after_first)) + 1;
      bundle.last = std::min(lattice_.num_along, static_cast<int>(std::max(-1.0f, after_last)) + 1);
      if (bundle.first >= bundle.last) continue;
      const Eigen::Vector3d start(x - lattice_.half() + from * n_.x(), b * v_.y() + from * n_.y(),
                                  b * v_.z() + from * n_.z());
      for (int axis = 0; axis < 3; ++axis) {
        bundle.start[axis] = LookupTable::toFixed(start[axis] + lattice_.middle + 0.5);
        bundle.step[axis] = step_[axis];
      }
      bundles.push_back(bundle);
    }
  }
}

}  // namespace pcl_symmetry
