/// What the convolution is made of: rows of cells, bundles of lines through them, and the sums of their lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/transform/lookup_table.h"
#include "core/transform/bundle_lattice.h"
#include "core/transform/lane_sums.h"
#include "shapes/shapes.h"

namespace pcl_symmetry {
namespace {

TEST(RowTable, HoldsEveryStepthCellOfARowSideBySide) {
  constexpr int kCells = 11;
  RandomStream random(1);
  std::vector<float> f(kCells * kCells * kCells);
  for (float& value : f) value = static_cast<float>(random.uniform());
  const auto byteOf = [&](const int(&cell)[3]) {
    double sq_distance = 0.0;
    for (const int c : cell) {
      if (c < 0 || c >= kCells) return 0;
      sq_distance += (c - 5.0) * (c - 5.0);
    }
    return sq_distance > 4.6 * 4.6
               ? 0
               : static_cast<int>(f[(cell[2] * kCells + cell[1]) * kCells + cell[0]] * 200.0f + 0.5f);
  };
  for (const int step : {1, 2, 3}) {
    const RowTable table(f, kCells, 4.6, step, 1);
    for (int axis = 0; axis < 3; ++axis) {
      const RowTable::Rows rows = table.along(axis);
      for (int z = 0; z < kCells; ++z)
        for (int y = 0; y < kCells; ++y)
          for (int x = -kRowLanes * step; x < kCells; ++x)
            for (int lane = 0; lane < kRowLanes; ++lane) {
              int cell[3];
              cell[axis] = x + lane * step;
              cell[(axis + 1) % 3] = y;
              cell[(axis + 2) % 3] = z;
              ASSERT_EQ(rows.bytes[z * rows.of_z + y * rows.of_y + rows.of_x[x] + lane], byteOf(cell))
                  << "axis " << axis << ", step " << step << ", cell " << x << " " << y << " " << z << ", lane "
                  << lane;
            }
    }
  }
}

TEST(LaneSums, LanesAtDifferentHeightsAreBroughtTogether) {
  // The narrowest that D can be: a Gaussian of sigma / 2 with places 0.44 sigma apart. Quintic splines are off by 0.16
  // % of it in theory, the lanes of one bundle by less.
  const auto value = [](double place) {
    return 1e6 * std::exp(-0.5 * (place - 20.3) * (place - 20.3) / (1.14 * 1.14));
  };
  for (const double ahead : {0.0, 0.37, -1.1}) {
    LaneSums sums(40, 10.0);
    for (int times = 1; times <= 2; ++times) {
      for (int s = 0; s < 40; ++s)
        for (int j = 0; j < kBundleLanes; ++j) {
          const double of_lane = (j % kRowLanes - 0.5 * (kRowLanes - 1)) * ahead;
          sums.data()[s * kBundleLanes + j] = static_cast<std::int32_t>(value(s + of_lane));
        }
      sums.bringTogether(ahead);
      for (int s = 0; s < 40; ++s) EXPECT_NEAR(sums.at(s), times * 16.0 * value(s), times * 16.0 * 2e3) << ahead;
    }
    EXPECT_EQ(sums.at(-1), 0.0f);
    EXPECT_EQ(sums.at(40), 0.0f);
    sums.clear();
    EXPECT_EQ(sums.at(20), 0.0f);
  }
}

/// Sums of products of all points of a bundle, as defined.
std::vector<std::int32_t> sumsByDefinition(const Bundle& bundle, const RowTable::Rows& rows, int num_places) {
  const auto v = [&](int l, int j) -> std::int32_t {
    const auto cell = [&](int axis) {
      return (bundle.start[j / kRowLanes][axis] + l * bundle.step[axis]) >> LookupTable::kFractionBits;
    };
    const int x = cell(0), y = cell(1), z = cell(2);
    if (x < rows.least_x || std::max({x, y, z}) > rows.last || std::min(y, z) < 0) return 0;
    return rows.bytes[z * rows.of_z + y * rows.of_y + rows.of_x[x] + j % kRowLanes];
  };
  std::vector<std::int32_t> sums(static_cast<std::size_t>(num_places) * kBundleLanes);
  for (int a = bundle.first; a < bundle.last; ++a)
    for (int b = bundle.first; b < bundle.last; ++b)
      for (int j = 0; j < kBundleLanes; ++j) sums[(a + b) * kBundleLanes + j] += v(a, j) * v(b, j);
  return sums;
}

/// Bundles of rows from row \p first on.
std::vector<Bundle> bundlesFrom(const BundlesOfDirection& bundles, int first, double shift) {
  BundlesOfDirection::Row rows[kBundleRows];
  for (int r = 0; r < kBundleRows; ++r) rows[r] = {(first + r) * bundles.between(), r * shift};
  std::vector<Bundle> found;
  bundles.addBundles(rows, found);
  return found;
}

TEST(BundleKernels, AddUpTheProductsOfAllPairs) {
  const GaussianEdt edt(test::asymmetricBlob(2000, 3).cloud(), {});
  const PlaneGrid grid(8, 8, 64, edt.center(), edt.radius());
  const BundleLattice lattice(edt, grid, 0.9);
  const RowTable table(edt.interpolation(), edt.numCells(), lattice.clip, lattice.step, 0);
  const int num_places = 2 * lattice.num_along;
  std::size_t num_bundles = 0;
  for (std::size_t direction = 0; direction < grid.numDirections(); direction += 5) {
    const BundlesOfDirection bundles(lattice, grid.normal(direction));
    const RowTable::Rows rows = table.along(bundles.axis());
    for (const Bundle& bundle : bundlesFrom(bundles, static_cast<int>(direction) % 30 - 15, 0.3)) {
      ++num_bundles;
      const std::vector<std::int32_t> expected = sumsByDefinition(bundle, rows, num_places);
      for (const Simd simd : {Simd::Scalar, Simd::Avx2, Simd::Avx512}) {
        if (!simdSupported(simd)) continue;
        const BundleKernels kernels = bundleKernels(simd);
        BundleValues values(lattice.num_along);
        LaneSums sums(num_places, 2.0 * lattice.most_ahead / lattice.along);
        kernels.look_up(bundle, rows, values);
        kernels.correlate(values, sums.data());
        ASSERT_TRUE(std::equal(expected.begin(), expected.end(), sums.data())) << static_cast<int>(simd);
      }
    }
  }
  EXPECT_GT(num_bundles, 50u);
}

TEST(BundlesOfDirection, CoverAllThatIsNotZero) {
  // As many values as the volume has: the mean of f over the lattice is that over the cells.
  const GaussianEdt edt(test::asymmetricBlob(2000, 3).cloud(), {});
  const PlaneGrid grid(8, 8, 64, edt.center(), edt.radius());
  const BundleLattice lattice(edt, grid, 0.9);
  const RowTable table(edt.values(), edt.numCells(), lattice.clip, lattice.step, 0);
  for (std::size_t direction = 0; direction < grid.numDirections(); ++direction) {
    const BundlesOfDirection bundles(lattice, grid.normal(direction));
    const RowTable::Rows rows = table.along(bundles.axis());
    double sum = 0.0;
    for (int i = -bundles.numRows(); i <= bundles.numRows(); i += kBundleRows) {
      for (const Bundle& bundle : bundlesFrom(bundles, i, 0.0)) {
        BundleValues values(lattice.num_along);
        bundleKernels(Simd::Auto).look_up(bundle, rows, values);
        for (int l = values.first; l < values.last; ++l)
          for (int lane = 0; lane < kBundleLanes; ++lane) sum += values.backAt(l)[2 * lane];
      }
    }
    EXPECT_NEAR(sum * bundles.volume() / LookupTable::kOne / edt.sum(), 1.0, 0.01) << "direction " << direction;
  }
}

}  // namespace
}  // namespace pcl_symmetry
