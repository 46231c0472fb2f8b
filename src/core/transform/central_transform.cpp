#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/transform/sampled_transform.h"
#include "pcl_symmetry/core/axial_transform.h"

namespace pcl_symmetry {

Eigen::Vector3d CenterMap::center(std::size_t index) const {
  const std::size_t n = num_centers;
  return origin + step * Eigen::Vector3d(static_cast<double>(index % n), static_cast<double>(index / n % n),
                                         static_cast<double>(index / n / n));
}

double CenterMap::operator()(const Eigen::Vector3d& x) const {
  if (values.empty()) return 0.0;
  const Eigen::Array3d position = (x - origin).array() / step;
  if (!((position >= 0.0).all() && (position <= num_centers - 1.0).all())) return 0.0;
  const Eigen::Array3i low = position.cast<int>().min(num_centers - 2);
  const Eigen::Array3d part = position - low.cast<double>();
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Array3i high(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Eigen::Array3i at = low + high;
    const std::size_t index = (static_cast<std::size_t>(at.z()) * num_centers + at.y()) * num_centers + at.x();
    sum += values[index] * (high.cast<double>() * part + (1 - high).cast<double>() * (1.0 - part)).prod();
  }
  return sum;
}

CenterMap centralTransform(const GaussianEdt& edt, int num_centers, const AxialTransformOptions& options,
                           const Visibility* visibility) {
  options.validate();
  check(num_centers >= 2 && num_centers <= 512, "num_centers", num_centers, "in [2, 512]");
  const LookupTable table(edt, freeSpace(edt, visibility, options.num_threads), options.num_threads);
  // The image of x is 2 c - x.
  const Eigen::Matrix3Xf reflected = -centeredSamples(edt, options.num_samples, options.seed, options.num_threads);
  // |f|^2 / S from the same samples: their noise cancels, so that no D exceeds 1 by the 2 % of the draw.
  double own = 0.0;
  for (Eigen::Index i = 0; i < reflected.cols(); ++i) {
    const Eigen::Array3i cell = (static_cast<float>(middleCell(edt)) - reflected.col(i).array()).round().cast<int>();
    own += edt.values()[(static_cast<std::size_t>(cell.z()) * edt.numCells() + cell.y()) * edt.numCells() + cell.x()];
  }
  const double scale = 1.0 / (own * LookupTable::kOne);
  CenterMap map;
  map.num_centers = num_centers;
  map.step = 2.0 * edt.radius() / num_centers;
  map.origin = edt.center().array() - edt.radius() + 0.5 * map.step;
  map.values.resize(static_cast<std::size_t>(num_centers) * num_centers * num_centers);
  parallelBlocks(num_centers, options.num_threads, [&](std::size_t z) {
    LineSums lines(edt, table, num_centers);
    const Eigen::Vector3f step(static_cast<float>(2.0 * map.step / edt.cellSize()), 0.0f, 0.0f);
    for (int y = 0; y < num_centers; ++y) {
      const std::size_t first = (z * num_centers + y) * num_centers;
      const Eigen::Vector3d start = 2.0 * toCells(edt, map.center(first));
      const LineSums::Totals& totals = lines.ofMoved(reflected, start.cast<float>(), step, 0, num_centers);
      for (int x = 0; x < num_centers; ++x) {
        const double d = scale * totals[0][x];
        map.values[first + x] = static_cast<float>(visibility ? seenSymmetry(d, scale * totals[1][x]) : d);
      }
    }
  });
  return map;
}

}  // namespace pcl_symmetry
