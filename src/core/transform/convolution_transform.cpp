#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/transform/bundle_lattice.h"
#include "core/transform/lane_sums.h"
#include "core/transform/lookup_table.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace pcl_symmetry {

namespace {

constexpr std::size_t convolved_per_block = 16;  // directions
// Steps of the R2 sequence, which fills the unit square evenly: 1 / g and 1 / g^2 with the plastic number
// g = 1.3247..., the root of g^3 = g + 1.
constexpr double kPhaseSteps[2] = {0.7548776662466927, 0.5698402909980532};

/// \return in [-0.5, 0.5).
double phase(double turns) {
  return turns - std::floor(turns) - 0.5;
}

/// D for all planes of one direction: the volume is resampled along the normal, and each line is correlated with its
/// reversal (Section 4.2).
///
/// Lines stand side by side in bundles: those through cells of the same row are looked up by one load. Their points lie
/// at different heights along the normal: the sums of each lane are brought to the bins of r in the end.
class DirectionConvolution {
public:
  DirectionConvolution(const BundleLattice& lattice, const RowTable& table, const BundleKernels& kernels)
      : lattice_(lattice),
        table_(table),
        kernels_(kernels),
        values_(lattice.num_along),
        sums_(2 * lattice.num_along, 2.0 * lattice.most_ahead / lattice.along) {
    // The sums of these fit in 32 bits
    most_bundles_ = static_cast<int>(std::max<std::int64_t>(
        1, std::numeric_limits<std::int32_t>::max() / (std::int64_t{255} * 255 * lattice.num_along)));
  }

  /// \param index of the direction in the grid.
  /// \param norm by which sums of products are divided.
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
    // Each direction has its own phase of the lattice, and each row one of its own along it, so that what aliasing is
    // left does not add up.
    const double phase_of_rows = phase(kPhaseSteps[0] * index);
    for (int i = -num_rows; i <= num_rows; i += kBundleRows) {
      BundlesOfDirection::Row rows_of_bundle[kBundleRows];
      for (int r = 0; r < kBundleRows; ++r)
        rows_of_bundle[r] = {(i + r + phase_of_rows) * bundles.between(),
                             phase(kPhaseSteps[1] * (index + i + r)) * lattice_.step};
      some_.clear();
      bundles.addBundles(rows_of_bundle, some_);
      for (const Bundle& bundle : some_) {
        kernels_.look_up(bundle, rows, values_);
        kernels_.correlate(values_, sums_.data());
        if (++num_added % most_bundles_ == 0) sums_.bringTogether(ahead);
      }
    }
    sums_.bringTogether(ahead);
  }

  const BundleLattice& lattice_;
  const RowTable& table_;
  BundleKernels kernels_;
  BundleValues values_;
  LaneSums sums_;
  std::vector<Bundle> some_;
  int most_bundles_;
};

}  // namespace

void ConvolutionTransformOptions::validate() const {
  check(spacing > 0.0 && spacing <= 1.0, "spacing", spacing, "in (0, 1]");
  checkNumThreads(num_threads);
  check(simdSupported(simd), "simd", static_cast<int>(simd), "one that this processor supports");
}

SymmetryMap convolutionTransform(const GaussianEdt& edt, const PlaneGrid& grid,
                                 const ConvolutionTransformOptions& options) {
  options.validate();
  const BundleLattice lattice(edt, grid, options.spacing);
  // 1/24: the look-up of the nearest cell is one box.
  const RowTable table(edt.sharpened(1.0 / 24.0, options.num_threads), edt.numCells(), lattice.clip, lattice.step,
                       options.num_threads);
  const double norm = edt.sqNorm() * LookupTable::kOne * LookupTable::kOne;
  const int num_radius = grid.numRadius();
  SymmetryMap map;
  map.grid = grid;
  map.method = TransformMethod::Convolution;
  map.sigma = edt.sigma();
  map.center_of_mass = grid.center();
  map.values.resize(grid.size());
  const auto run = [&](std::size_t begin, std::size_t end) {
    DirectionConvolution convolution(lattice, table, bundleKernels(options.simd));
    for (std::size_t direction = begin; direction < end; ++direction)
      convolution.run(grid.normal(direction), direction, norm, num_radius, map.values.data() + direction * num_radius);
  };
  parallelRanges(grid.numDirections(), convolved_per_block, options.num_threads, run);
  return map;
}

}  // namespace pcl_symmetry
