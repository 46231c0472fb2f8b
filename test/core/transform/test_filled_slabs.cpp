#include "core/transform/filled_slabs.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

TEST(FilledSlabs, HoldEveryCellWithF) {
  RandomStream random(3);
  Points points(3, 300);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    points.col(i) = Eigen::Vector3d(random.uniform(), 0.3 * random.uniform(), 0.2 * random.uniform()).cast<float>();
  GaussianEdtOptions options;
  options.num_cells = 32;
  const GaussianEdt edt(points, options);
  Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor> samples(3, 2);
  samples.col(0) = Eigen::Vector3f(4.0f, 9.0f, 20.0f);
  samples.col(1) = Eigen::Vector3f(15.5f, 15.5f, 15.5f);
  const FilledSlabs filled(edt, samples);
  const SlabsOfSamples slabs = filled.from(0);
  ASSERT_EQ(slabs.count, 13);
  std::size_t num_outside = 0;
  for (std::size_t cell = 0; cell < edt.values().size(); ++cell) {
    const Eigen::Vector3f place(static_cast<float>(cell % 32), static_cast<float>(cell / 32 % 32),
                                static_cast<float>(cell / 1024));
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3f x =
          place + Eigen::Vector3f(corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f);
      bool is_inside = true;
      for (Eigen::Index i = 0; i < samples.cols(); ++i)
        for (int s = 0; s < slabs.count; ++s) {
          const float along = Eigen::Map<const Eigen::Vector3f>(slabs.axes + 3 * s).dot(x - samples.col(i));
          is_inside &= slabs.low[slabs.stride * s + i] <= along && along <= slabs.high[slabs.stride * s + i];
        }
      if (edt.values()[cell] > 0.0f) {
        ASSERT_TRUE(is_inside) << "cell " << cell;
      }
      num_outside += is_inside ? 0 : 1;
    }
  }
  EXPECT_GT(num_outside, 8 * edt.values().size() / 2) << "a slender shape fills a small part of its ball";
}

}  // namespace
}  // namespace pcl_symmetry
