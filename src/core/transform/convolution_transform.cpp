#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/simd.h"
#include "core/transform/sampled_transform.h"
#include "core/transform/transform_rules.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t kConvolvedPerBlock = 16;  // directions

// Steps of the R2 sequence, which fills the unit square evenly: 1 / g and 1 / g^2 with the plastic number
// g = 1.3247..., the root of g^3 = g + 1.
constexpr double kPhaseSteps[2] = {0.7548776662466927, 0.5698402909980532};

constexpr int kRowLanes = 8;    ///< lines of a bundle through cells of the same row, whose values one load reads
constexpr int kBundleRows = 2;  ///< rows whose lanes make a bundle
constexpr int kBundleLanes = kBundleRows * kRowLanes;

/// Parallel lines of equally spaced points, through kRowLanes cells of each of some rows: point l of the first one of
/// row r is start[r] + l * step, in fixed-point cells, for l in [first, last). What lies beyond the cube is 0.
struct Bundle {
  std::int32_t start[kBundleRows][3];
  std::int32_t step[3];
  int first, last;
};

bool isNearlyWhole(double cells) {
  return std::abs(cells - std::round(cells)) < kTransform.near_whole;
}

/// The lattice that the EDT is resampled on, and the bins of r, common to all directions. Lengths are in cells;
/// positions are relative to the middle of the EDT's cube, beyond whose inscribed ball f is taken as 0.
struct BundleLattice {
  BundleLattice(const GaussianEdt& edt, const PlaneGrid& grid, double spacing_in_sigmas)
      : middle(middleCell(edt)),
        clip(middle - 0.5),
        center(toCells(edt, grid.center())),
        grid_offset(grid.offset(0) / edt.cellSize()),
        radius_step(grid.radiusStep() / edt.cellSize()),
        spacing(spacing_in_sigmas * edt.sigma() / edt.cellSize()),
        step(std::max(1, static_cast<int>(kTransform.max_stretch * spacing))),
        refine(static_cast<int>(std::ceil(2.0 * radius_step / spacing))) {
    if (isNearlyWhole(2.0 * radius_step / refine)) ++refine;
    along = 2.0 * radius_step / refine;
    max_ahead = half() / std::sqrt(3.0);  // the axis that is farthest from n has a component of at most 1 / sqrt(3)
    num_along = static_cast<int>(std::ceil(2.0 * (clip + max_ahead + radius_step) / along)) + 2;
    const int n = edt.numCells();
    for (int row = 0; row < n * n; ++row) {
      const GaussianEdt::Range range = edt.filledRanges()[row];
      if (range.begin == range.end) continue;
      for (const int x : {range.begin, range.end - 1})
        filled.extend((Eigen::Vector3d(x, row % n, row / n).array() - middle).matrix());
    }
  }

  /// \return distance from the middle of a row of a bundle to its first and last line.
  double half() const { return 0.5 * (kRowLanes - 1) * step; }

  Eigen::AlignedBox3d filled;  ///< around the centers of the cells in which f is not 0
  double middle;               ///< coordinate of the middle, in cells from the first cell center
  double clip;                 ///< radius of the ball beyond which f is taken as 0
  Eigen::Vector3d center;      ///< center of the grid of planes
  double grid_offset;          ///< offset of the first bin from the center of the grid
  double radius_step;
  double spacing;  ///< distance between parallel lines
  int step;        ///< distance between the lines of a bundle, along an axis of the cells
  /// Points at t0 + l * along have the planes between them at t0 + (a + b) * along / 2: every refine-th one is a bin.
  int refine;
  double along;      ///< distance between the points of a line
  double max_ahead;  ///< distance from the middle of a row to its first and last line, along the normal
  int num_along;     ///< number of points of a line
};

/// The bundles of one direction: lines along the normal n through every step-th cell of rows of cells. Rows lie along
/// the axis e that is farthest from n, at equal distances along v, which is perpendicular to both. Vectors have e
/// first.
///
/// Point l of the middle of a row of a bundle has the height t = t0 + l * along, and lies at x e + b v + tau n with tau
/// = t - x n.x.
class BundlesOfDirection {
public:
  BundlesOfDirection(const BundleLattice& lattice, const Eigen::Vector3d& normal) : lattice_(lattice) {
    normal.cwiseAbs().minCoeff(&axis_);
    n_ = {normal[axis_], normal[(axis_ + 1) % 3], normal[(axis_ + 2) % 3]};
    across_ = std::hypot(n_.y(), n_.z());
    v_ = Eigen::Vector3d(0.0, -n_.z(), n_.y()) / across_;
    between_ = std::min(lattice.spacing, lattice.spacing * lattice.spacing / (lattice.step * across_));
    if (isNearlyWhole(between_)) between_ *= kTransform.less_than_whole;
    const double first_offset = normal.dot(lattice.center) + lattice.grid_offset;
    num_skipped_ = std::floor((-lattice.clip - lattice.max_ahead - first_offset) / lattice.radius_step);
    t0_ = first_offset + num_skipped_ * lattice.radius_step;
    for (int i = 0; i < 3; ++i) step_[i] = LookupTable::toFixed(lattice.along * n_[i]);
  }

  int axis() const { return axis_; }  ///< axis of the rows
  /// \return number of bins from t0 to the first one, times -1.
  double numSkipped() const { return num_skipped_; }
  double between() const { return between_; }  ///< distance between rows
  /// \return difference in height of neighboring lines of a row, in cells.
  double ahead() const { return lattice_.step * n_.x(); }
  /// \return volume that each point represents, in cells.
  double volume() const { return lattice_.along * between_ * lattice_.step * across_; }
  /// \return number of rows on each side of the middle.
  int numRows() const { return static_cast<int>(std::ceil(lattice_.clip / between_)); }

  /// Where a row of the lattice lies.
  struct Row {
    double b;
    double shift;  ///< offset along the row
  };
  /// The bundles of kBundleRows rows, each cut to where it can meet nonzero cells; empty ones are left out.
  std::vector<Bundle> bundles(const Row* rows) const {
    std::vector<Bundle> bundles;
    // The projection of the ball along n is an ellipse. Rows are shifted by up to half a step.
    const double width = kRowLanes * lattice_.step;
    const int num_side = static_cast<int>(std::ceil(lattice_.clip / (across_ * width) + 0.5 / kRowLanes));
    for (int c = -num_side; c < num_side; ++c) {
      Bundle bundle;
      double first = lattice_.num_along, last = -1.0;
      for (int r = 0; r < kBundleRows; ++r) {
        const double x = static_cast<float>((c + 0.5) * width + rows[r].shift);
        const double tau = t0_ - x * n_.x();  // tau of point 0
        const auto [from, to] = filledPart(x, rows[r].b);
        if (from <= to) {
          first = std::min(first, (from - tau) / lattice_.along);
          last = std::max(last, (to - tau) / lattice_.along);
        }
        const Eigen::Vector3d start(x - lattice_.half() + tau * n_.x(), rows[r].b * v_.y() + tau * n_.y(),
                                    rows[r].b * v_.z() + tau * n_.z());
        for (int axis = 0; axis < 3; ++axis)
          bundle.start[r][axis] = LookupTable::toFixed(start[axis] + lattice_.middle + 0.5);
      }
      bundle.first = static_cast<int>(std::max(0.0, first));
      bundle.last = std::min(lattice_.num_along, static_cast<int>(last) + 1);
      if (bundle.first >= bundle.last) continue;
      std::copy_n(step_, 3, bundle.step);
      bundles.push_back(bundle);
    }
    return bundles;
  }

private:
  /// The heights tau between which the lines of a bundle of a row can meet nonzero cells.
  /// \param x position of the middle of the bundle.
  std::pair<double, double> filledPart(double x, double b) const {
    // A look-up reads the whole cell; fixed-point steps are rounded.
    const double of_cell = 0.51, min_slope = 1e-5;
    const double radius = lattice_.clip + lattice_.half() + std::sqrt(3.0) * of_cell;
    const double chord = std::sqrt(std::max(0.0, radius * radius - x * x - b * b + x * n_.x() * x * n_.x()));
    double from = -x * n_.x() - chord, to = -x * n_.x() + chord;
    for (int k = 0; k < 3; ++k) {
      const int axis = (axis_ + k) % 3;
      const double foot = (k == 0 ? x : b * v_[k]), reach = of_cell + (k == 0 ? lattice_.half() : 0.0);
      const double slope = std::copysign(std::max(std::abs(n_[k]), min_slope), n_[k]);
      const auto [enter, leave] = std::minmax(
          {(lattice_.filled.min()[axis] - reach - foot) / slope, (lattice_.filled.max()[axis] + reach - foot) / slope});
      from = std::max(from, enter);
      to = std::min(to, leave);
    }
    return {from, to};
  }

  const BundleLattice& lattice_;
  int axis_ = 0;
  Eigen::Vector3d n_, v_;
  double across_;       ///< distance of lines through neighboring cells of a row
  double between_;      ///< distance between rows
  double num_skipped_;  ///< number of bins from t0 to the first one, times -1
  double t0_;           ///< height of the first points of all bundles
  std::int32_t step_[3];
};

/// \return fractional part, in [-0.5, 0.5).
double phase(double rotations) {
  return rotations - std::floor(rotations) - 0.5;
}

/// The cells of an EDT as bytes in rows along each of the three axes, for points that are several cells of a row apart:
/// of every step-th cell of a row, kRowLanes are stored side by side, whichever is the first. Values are multiplied by
/// LookupTable::kOne; cells beyond a ball and beyond the cube are 0.
class RowTable {
public:
  /// \param f num_cells^3 values in [0, 255 / LookupTable::kOne], x fastest.
  /// \param clip radius in cells; cells whose centers are farther from the middle of the cube are 0.
  /// \param step distance of the cells of a row that are stored side by side, >= 1.
  RowTable(const std::vector<float>& f, int num_cells, double clip, int step, int num_threads)
      : num_cells_(num_cells), step_(step) {
    const int n = num_cells;
    stride_ = (n + step - 1) / step + kRowLanes;  // the lanes before a row are those after the previous one
    const std::size_t of_phase = static_cast<std::size_t>(n) * n * stride_;
    size_ = of_phase * step;
    for (int x = -kRowLanes * step; x < n; ++x) {
      const int shifted = x + kRowLanes * step;
      of_x_.push_back(static_cast<std::int32_t>((shifted % step) * of_phase) + shifted / step);
    }
    bytes_.assign(3 * size_ + 2 * kRowLanes, 0);
    const double middle = 0.5 * (n - 1);
    parallelBlocks(n, num_threads, [&](std::size_t slice) {
      const int c = static_cast<int>(slice);
      for (int b = 0; b < n; ++b) {
        const double sq_left = clip * clip - (b - middle) * (b - middle) - (c - middle) * (c - middle);
        if (sq_left < 0.0) continue;
        const int first = static_cast<int>(std::ceil(middle - std::sqrt(sq_left)));
        const int last = static_cast<int>(std::floor(middle + std::sqrt(sq_left)));
        const float* row = f.data() + (slice * n + b) * n;
        for (int a = first; a <= last; ++a) {
          const float scaled = row[a] * static_cast<float>(LookupTable::kOne) + 0.5f;
          const auto byte = static_cast<std::uint8_t>(static_cast<int>(std::min(scaled, LookupTable::kMaxValue)));
          const auto put = [&](int axis, int x, int y, int z) {
            const Rows rows = along(axis);
            bytes_[axis * size_ + static_cast<std::size_t>(z * rows.of_z + y * rows.of_y + rows.of_x[x])] = byte;
          };
          put(0, a, b, c);
          put(1, b, c, a);
          put(2, c, a, b);
        }
      }
    });
  }

  /// Rows along one axis. Cell (x, y, z) has x along it, y along the next axis and z along the one after that,
  /// cyclically. Its byte is bytes[z * of_z + y * of_y + of_x[x]]; x may lie in
  /// [-kRowLanes * step, num_cells), y and z in [0, num_cells).
  struct Rows {
    const std::uint8_t* bytes;
    const std::int32_t* of_x;
    int of_y, of_z;
    int min_x;  ///< least x
    int last;   ///< last cell of a row
  };
  Rows along(int axis) const {
    const int before = kRowLanes * step_;
    return {
        bytes_.data() + axis * size_, of_x_.data() + before, stride_, num_cells_ * stride_, -before, num_cells_ - 1};
  }

private:
  int num_cells_, step_;
  int stride_;        // bytes of a row: cells of one phase between kRowLanes empty cells
  std::size_t size_;  // bytes for one axis
  std::vector<std::int32_t> of_x_;
  std::vector<std::uint8_t> bytes_;
};

/// Looks up the points of a bundle, each in the cell that contains it.
/// \param[out] values kBundleLanes values for each point.
PCL_SYMMETRY_MULTIVERSION
void lookUp(Bundle bundle, const RowTable::Rows& rows, std::int32_t* __restrict offsets, float* __restrict values) {
  const int first = bundle.first, last = bundle.last;
  const std::int32_t* __restrict const of_x = rows.of_x;
  const int of_y = rows.of_y, of_z = rows.of_z, min_x = rows.min_x, last_cell = rows.last;
  for (int r = 0; r < kBundleRows; ++r) {
    for (int l = first; l < last; ++l) {
      const auto cell = [&](int axis, int first_cell) {
        const int at = (bundle.start[r][axis] + l * bundle.step[axis]) >> LookupTable::kFractionBits;
        return at < first_cell ? first_cell : at > last_cell ? last_cell : at;
      };
      offsets[l] = cell(2, 0) * of_z + cell(1, 0) * of_y + of_x[cell(0, min_x)];
    }
    for (int l = first; l < last; ++l)
      for (int j = 0; j < kRowLanes; ++j)
        values[l * kBundleLanes + r * kRowLanes + j] = static_cast<float>(rows.bytes[offsets[l] + j]);
  }
}

/// sums[s * kBundleLanes + j] += sum over a + b = s of v[a] v[b] of lane j, for points in [first, last).
PCL_SYMMETRY_MULTIVERSION
void correlate(const float* values, int first, int last, std::int32_t* sums) {
  typedef float Lanes __attribute__((vector_size(kBundleLanes * sizeof(float))));
  for (int s = 2 * first; s < 2 * last - 1; ++s) {
    // Products of two different points count twice. The sums are integers that a float holds without rounding.
    Lanes total{}, a, b;
    for (int low = std::max(first, s - last + 1); 2 * low < s; ++low) {
      std::memcpy(&a, values + low * kBundleLanes, sizeof a);
      std::memcpy(&b, values + (s - low) * kBundleLanes, sizeof b);
      total += a * b;
    }
    total += total;
    if (s % 2 == 0) {
      std::memcpy(&a, values + s / 2 * kBundleLanes, sizeof a);
      total += a * a;
    }
    for (int j = 0; j < kBundleLanes; ++j) sums[s * kBundleLanes + j] += static_cast<std::int32_t>(total[j]);
  }
}

// Poles of the quintic spline: roots within the unit circle of z^4 + 26 z^3 + 66 z^2 + 26 z + 1.
constexpr double kPoles[2] = {-0.4305753470999738, -0.0430962882032647};
constexpr int kReachOfSpline = 12;  // values on each side that a coefficient depends on: pole^13 = 2e-5 is left out
constexpr int kNumTaps = 6;         // coefficients that a value of quintic splines depends on

/// Weights of the coefficients -2 to 3 for the value at t in [0, 1].
std::array<float, kNumTaps> weightsAt(double t) {
  const auto spline = [](double x) {
    if (x <= 1.0) return 11.0 / 20.0 - x * x * (1.0 / 2.0 - x * x * (1.0 / 4.0 - x / 12.0));
    if (x <= 2.0) return 17.0 / 40.0 + x * (5.0 / 8.0 - x * (7.0 / 4.0 - x * (5.0 / 4.0 - x * (3.0 / 8.0 - x / 24.0))));
    return std::pow(3.0 - x, 5) / 120.0;
  };
  std::array<float, kNumTaps> weights;
  for (int k = 0; k < kNumTaps; ++k) weights[k] = static_cast<float>(spline(std::abs(t - (k - 2))));
  return weights;
}

/// \return weights of values at distances up to kReachOfSpline for a coefficient.
std::array<float, kReachOfSpline + 1> weightsOfValues() {
  std::array<float, kReachOfSpline + 1> weights{};
  for (const double z : kPoles) {
    const double slope = (2.0 * z + 26.0 - 26.0 / (z * z) - 2.0 / (z * z * z)) / 120.0;
    for (int k = 0; k <= kReachOfSpline; ++k) weights[k] += static_cast<float>(std::pow(z, k) / (z * slope));
  }
  return weights;
}

PCL_SYMMETRY_MULTIVERSION
void addLane(const float* values, int size, const float* weights, float* sums) {
  const float w0 = weights[0], w1 = weights[1], w2 = weights[2], w3 = weights[3], w4 = weights[4], w5 = weights[5];
  for (int s = 0; s < size; ++s) {
    const float* const here = values + s;
    sums[s] += ((w0 * here[-2] + w1 * here[-1]) + (w2 * here[0] + w3 * here[1])) + (w4 * here[2] + w5 * here[3]);
  }
}

/// Sums of the lanes of bundles at equally spaced positions, which differ between the lanes of a row by a fraction of
/// the distance; and their total at common positions, by quintic splines (Unser, Splines: a perfect fit, 1999).
class LaneSums {
public:
  /// \param max_ahead greatest offset of the first and the last lane of a row from its middle, distances of positions.
  LaneSums(int size, double max_ahead)
      : size_(size),
        margin_(static_cast<int>(std::ceil(max_ahead)) + kNumTaps),
        sums_(static_cast<std::size_t>(size) * kBundleLanes),
        lane_(size + 2 * margin_),
        coefficients_(size + 2 * kReachOfSpline) {}

  /// \return number s * kBundleLanes + j is the sum of lane j at position s.
  std::int32_t* data() { return sums_.data(); }

  /// Adds the sums to the values at common positions, and sets them to 0.
  /// \param ahead offset of each lane of a row from the lane before, distances of positions; the middle of a row is at
  /// the common positions.
  void bringTogether(double ahead) {
    for (int j = 0; j < kRowLanes; ++j) {
      const double of_lane = (j - 0.5 * (kRowLanes - 1)) * ahead;
      const int shift = static_cast<int>(std::ceil(of_lane));
      for (int s = 0; s < size_; ++s) {
        lane_[margin_ + s] = 0.0f;
        for (int r = j; r < kBundleLanes; r += kRowLanes)
          lane_[margin_ + s] += static_cast<float>(sums_[s * kBundleLanes + r]);
      }
      addLane(lane_.data() + margin_ - shift, size_, weightsAt(shift - of_lane).data(),
              coefficients_.data() + kReachOfSpline);
    }
    std::fill(sums_.begin(), sums_.end(), 0);
  }

  /// \return the value at common position s, 0 outside of [0, size).
  float at(std::int64_t s) const {
    static const std::array<float, kReachOfSpline + 1> kWeights = weightsOfValues();
    if (s < 0 || s >= size_) return 0.0f;
    const float* const here = coefficients_.data() + kReachOfSpline + s;
    float value = kWeights[0] * here[0];
    for (int k = 1; k <= kReachOfSpline; ++k) value += kWeights[k] * (here[-k] + here[k]);
    return value;
  }

  /// Sets the values to 0.
  void clear() { std::fill(coefficients_.begin(), coefficients_.end(), 0.0f); }

private:
  int size_;
  int margin_;  // zeros on both sides of lane_
  std::vector<std::int32_t> sums_;
  std::vector<float> lane_;
  // Coefficients of the spline through the values, with kReachOfSpline zeros on both sides.
  std::vector<float> coefficients_;
};

/// D for all planes of one direction: the volume is resampled along the normal, and each line is correlated with its
/// reversal (Section 4.2).
///
/// Lines are grouped in bundles: lines through cells of the same row are looked up by one load. Their points lie at
/// different heights along the normal; in the end, the sums of each lane are interpolated at the bins of r.
class DirectionConvolution {
public:
  DirectionConvolution(const BundleLattice& lattice, const RowTable& table)
      : lattice_(lattice),
        table_(table),
        offsets_(lattice.num_along),
        values_(static_cast<std::size_t>(lattice.num_along) * kBundleLanes),
        sums_(2 * lattice.num_along, 2.0 * lattice.max_ahead / lattice.along) {
    // The sums of these products fit in 32 bits.
    constexpr auto most = static_cast<std::int64_t>(LookupTable::kMaxValue);
    max_bundles_ = static_cast<int>(
        std::max<std::int64_t>(1, std::numeric_limits<std::int32_t>::max() / (most * most * lattice.num_along)));
  }

  /// \param index of the direction in the grid.
  /// \param norm divisor of the sums of products.
  /// \param[out] d num_radius values of D.
  void run(const Eigen::Vector3d& normal, std::size_t index, double norm, int num_radius, float* d) {
    const BundlesOfDirection bundles(lattice_, normal);
    sums_.clear();
    add(bundles, static_cast<double>(index));
    const double scale = bundles.volume() / norm;
    for (int k = 0; k < num_radius; ++k) {
      const double s = (k - bundles.numSkipped()) * lattice_.refine;
      d[k] = static_cast<float>(scale * sums_.at(static_cast<std::int64_t>(s)));
    }
  }

private:
  void add(const BundlesOfDirection& bundles, double index) {
    const RowTable::Rows rows = table_.along(bundles.axis());
    const double ahead = 2.0 * bundles.ahead() / lattice_.along;
    const int num_rows = bundles.numRows();
    int num_added = 0;
    // Each direction has its own phase of the lattice, and each row one of its own along it, so that the remaining
    // aliasing does not add up.
    const double phase_of_rows = phase(kPhaseSteps[0] * index);
    for (int i = -num_rows; i <= num_rows; i += kBundleRows) {
      BundlesOfDirection::Row rows_of_bundle[kBundleRows];
      for (int r = 0; r < kBundleRows; ++r)
        rows_of_bundle[r] = {(i + r + phase_of_rows) * bundles.between(),
                             phase(kPhaseSteps[1] * (index + i + r)) * lattice_.step};
      for (const Bundle& bundle : bundles.bundles(rows_of_bundle)) {
        lookUp(bundle, rows, offsets_.data(), values_.data());
        int first = bundle.first, last = bundle.last;
        while (first < last && isZero(first)) ++first;
        while (first < last && isZero(last - 1)) --last;
        correlate(values_.data(), first, last, sums_.data());
        if (++num_added % max_bundles_ == 0) sums_.bringTogether(ahead);
      }
    }
    sums_.bringTogether(ahead);
  }

  bool isZero(int point) const {
    const float* const lanes = values_.data() + point * kBundleLanes;
    return std::all_of(lanes, lanes + kBundleLanes, [](float value) { return value == 0.0f; });
  }

  const BundleLattice& lattice_;
  const RowTable& table_;
  std::vector<std::int32_t> offsets_;  // offsets of the points of a row of a bundle
  std::vector<float> values_;          // values of the points of a bundle, lane by lane
  LaneSums sums_;
  int max_bundles_;
};

}  // namespace

void ConvolutionTransformOptions::validate() const {
  check(spacing > 0.0 && spacing <= 1.0, "spacing", spacing, "in (0, 1]");
  checkNumThreads(num_threads);
}

SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options) {
  options.validate();
  const BundleLattice lattice(edt, grid, options.spacing);
  // Half of it, because the look-up of the nearest cell is one box, and interpolation is two.
  const RowTable table(edt.sharpened(0.5 * kTransform.of_interpolation, options.num_threads), edt.numCells(),
                       lattice.clip, lattice.step, options.num_threads);
  const double norm = edt.sqNorm() * LookupTable::kOne * LookupTable::kOne;
  const int num_radius = grid.numRadius();
  SymmetryMap map = SymmetryMap::zero(edt, grid, TransformMethod::Convolution);
  parallelRanges(grid.numDirections(), kConvolvedPerBlock, options.num_threads,
                 [&](std::size_t begin, std::size_t end) {
                   DirectionConvolution convolution(lattice, table);
                   for (std::size_t direction = begin; direction < end; ++direction)
                     convolution.run(grid.normal(direction), direction, norm, num_radius,
                                     map.values.data() + direction * num_radius);
                 });
  return map;
}

}  // namespace pcl_symmetry
