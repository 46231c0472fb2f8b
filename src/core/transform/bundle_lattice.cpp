#include "core/transform/bundle_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/simd.h"
#include "core/transform/lookup_table.h"
#include "core/transform/transform_rules.h"

namespace pcl_symmetry {

namespace {

constexpr float far_points = 1e6f;    // farther than all of a line
constexpr int at_once = 16;           // bundles that are cut together: floats in an AVX-512 register
constexpr float slab_slack = 0.01f;   // cells; more than fixed-point steps and floats are rounded by
constexpr float least_slope = 1e-5f;  // along 512 cells a slab is left by less than its slack

bool isNearlyWhole(double cells) {
  return std::abs(cells - std::round(cells)) < kTransform.near_whole;
}

/// Where bundles with their middles at x enter the last slab and leave the first one.
PCL_SYMMETRY_MULTIVERSION
void cutAtSlabs(const float* entry, const float* exit, const float* of_x, const float* x, float* first, float* last) {
  typedef float Lanes __attribute__((vector_size(4 * at_once)));
  Lanes middle, low, high;
  std::memcpy(&middle, x, sizeof middle);
  low = entry[0] - middle * of_x[0];
  high = exit[0] - middle * of_x[0];
  for (int k = 1; k < kNumSlabs; ++k) {
    const Lanes moved = middle * of_x[k];
    const Lanes entered = entry[k] - moved, left = exit[k] - moved;
    low = low < entered ? entered : low;
    high = left < high ? left : high;
  }
  std::memcpy(first, &low, sizeof low);
  std::memcpy(last, &high, sizeof high);
}

}  // namespace

SlabsOfCells::SlabsOfCells(const GaussianEdt& edt) {
  // The directions from a cell to its neighbors, one of each pair.
  for (int code = 14; code < 27; ++code)
    axes.row(code - 14) << static_cast<float>(code % 3 - 1), static_cast<float>(code / 3 % 3 - 1),
        static_cast<float>(code / 9 - 1);
  constexpr float far = 1e6f;  // farther than every cell
  low.setConstant(far);
  high.setConstant(-far);
  const int n = edt.numCells();
  for (int row = 0; row < n * n; ++row) {
    const GaussianEdt::Range filled = edt.filledRanges()[static_cast<std::size_t>(row)];
    if (filled.begin == filled.end) continue;
    for (const int x : {filled.begin, filled.end - 1}) {
      const Eigen::Matrix<float, kNumSlabs, 1> along =
          axes * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(row % n), static_cast<float>(row / n));
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    }
  }
  // A look-up takes the whole cell.
  const Eigen::Matrix<float, kNumSlabs, 1> of_cell = 0.5f * axes.cwiseAbs().rowwise().sum().array() + slab_slack;
  low -= of_cell;
  high += of_cell;
}

BundleLattice::BundleLattice(const GaussianEdt& edt, const PlaneGrid& grid, double spacing_in_sigmas) : slabs(edt) {
  middle = 0.5 * (edt.numCells() - 1);
  clip = middle - 0.5;
  center = ((grid.center() - edt.origin()) / edt.cellSize()).array() - middle;
  grid_offset = grid.offset(0) / edt.cellSize();
  radius_step = grid.radiusStep() / edt.cellSize();
  spacing = spacing_in_sigmas * edt.sigma() / edt.cellSize();
  step = std::max(1, static_cast<int>(kTransform.most_stretch * spacing));
  refine = static_cast<int>(std::ceil(2.0 * radius_step / spacing));
  if (isNearlyWhole(2.0 * radius_step / refine)) ++refine;
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
  if (isNearlyWhole(between_)) between_ *= kTransform.less_than_whole;
  const double first_offset = normal.dot(lattice.center) + lattice.grid_offset;
  num_skipped_ = std::floor((-lattice.clip - lattice.most_ahead - first_offset) / lattice.radius_step);
  t0_ = first_offset + num_skipped_ * lattice.radius_step;
  for (int i = 0; i < 3; ++i) step_[i] = LookupTable::toFixed(lattice.along * n_[i]);
  setSlabs();
}

void BundlesOfDirection::setSlabs() {
  const Eigen::Vector3f n = n_.cast<float>(), v = v_.cast<float>();
  for (int k = 0; k < kNumSlabs; ++k) {
    const auto all = lattice_.slabs.axes.row(k);
    const Eigen::Vector3f w(all[axis_], all[(axis_ + 1) % 3], all[(axis_ + 2) % 3]);
    const float slope = std::copysign(std::max(std::abs(w.dot(n)), least_slope), w.dot(n));
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

/// Widens [first, last] to where bundles with their middles at x meet all slabs, in points of a line.
void BundlesOfDirection::cutRow(const Row& row, const float* x, float* first, float* last) const {
  float entry[kNumSlabs], exit[kNumSlabs], low[at_once], high[at_once];
  for (int k = 0; k < kNumSlabs; ++k) {
    entry[k] = entry_[k] - static_cast<float>(row.b) * of_b_[k];
    exit[k] = exit_[k] - static_cast<float>(row.b) * of_b_[k];
  }
  cutAtSlabs(entry, exit, of_x_, x, low, high);
  const auto scale = static_cast<float>(1.0 / lattice_.along), t0 = static_cast<float>(t0_),
             nx = static_cast<float>(n_.x());
  for (int i = 0; i < at_once; ++i) {
    const bool meets = low[i] <= high[i];
    const float from = t0 - x[i] * nx;  // tau of point 0
    first[i] = std::min(first[i], meets ? (low[i] - from) * scale : far_points);
    last[i] = std::max(last[i], meets ? (high[i] - from) * scale : -far_points);
  }
}

void BundlesOfDirection::addBundles(const Row* rows, std::vector<Bundle>& bundles) const {
  // The ball casts an ellipse along n. Rows are shifted by up to half a step.
  const double width = kRowLanes * lattice_.step;
  const int num_side = static_cast<int>(std::ceil(lattice_.clip / (across_ * width) + 0.5 / kRowLanes));
  for (int c = -num_side; c < num_side; c += at_once) {
    float x[kBundleRows][at_once], first[at_once], last[at_once];
    std::fill_n(first, at_once, far_points);
    std::fill_n(last, at_once, -far_points);
    for (int r = 0; r < kBundleRows; ++r) {
      for (int i = 0; i < at_once; ++i) x[r][i] = static_cast<float>((c + i + 0.5) * width + rows[r].shift);
      cutRow(rows[r], x[r], first, last);
    }
    for (int i = 0; i < std::min(at_once, num_side - c); ++i) {
      Bundle bundle;
      bundle.first = static_cast<int>(std::max(0.0f, first[i])) + 1;
      bundle.last = std::min(lattice_.num_along, static_cast<int>(std::max(-1.0f, last[i])) + 1);
      if (bundle.first >= bundle.last) continue;
      for (int r = 0; r < kBundleRows; ++r) {
        const double from = t0_ - x[r][i] * n_.x();
        const Eigen::Vector3d start(x[r][i] - lattice_.half() + from * n_.x(), rows[r].b * v_.y() + from * n_.y(),
                                    rows[r].b * v_.z() + from * n_.z());
        for (int axis = 0; axis < 3; ++axis)
          bundle.start[r][axis] = LookupTable::toFixed(start[axis] + lattice_.middle + 0.5);
      }
      std::copy_n(step_, 3, bundle.step);
      bundles.push_back(bundle);
    }
  }
}

}  // namespace pcl_symmetry
