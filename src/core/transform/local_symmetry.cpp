#include "pcl_symmetry/core/local_symmetry.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/geometry/directions.h"

namespace pcl_symmetry {

void LocalSymmetryOptions::validate() const {
  check(std::isfinite(scale) && scale > 0.0, "scale", scale, "finite and > 0");
  check(num_directions >= 1, "num_directions", num_directions, ">= 1");
  check(num_samples >= 1, "num_samples", num_samples, ">= 1");
  checkNumThreads(num_threads);
}

std::vector<float> localSymmetry(const GaussianEdt& edt, const PointsRef& points, const LocalSymmetryOptions& options) {
  options.validate();
  const double cell = edt.cellSize(), scale = options.scale / cell;
  const auto& values = edt.values();
  std::vector<Eigen::Vector3d> normals;
  for (int k = 0; k < options.num_directions; ++k)
    normals.push_back(spiralDirection(k, options.num_directions, k * kGoldenAngle));
  std::vector<float> result(points.cols(), 0.0f);
  parallelRanges(result.size(), 64, options.num_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      // The cells of the window in which f is not 0.
      const Eigen::Vector3d p = (points.col(i).cast<double>() - edt.origin()) / cell;
      const int n = edt.numCells();
      const Eigen::Vector3d low = (p.array() - scale).ceil().max(0.0), high = (p.array() + scale).floor().min(n - 1.0);
      std::vector<Eigen::Vector3d> cells;
      std::vector<double> up_to;  // cumulative sums of w^2 f
      double sum = 0.0, sq_norm = 0.0;
      for (int z = static_cast<int>(low.z()); z <= high.z(); ++z)
        for (int y = static_cast<int>(low.y()); y <= high.y(); ++y)
          for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
            const float f = values[(static_cast<std::size_t>(z) * n + y) * n + x];
            const Eigen::Vector3d offset = Eigen::Vector3d(x, y, z) - p;
            const double left = 1.0 - offset.squaredNorm() / (scale * scale);
            if (f <= 0.0f || left <= 0.0) continue;
            sum += std::pow(left, 4) * f;
            sq_norm += std::pow(left, 4) * f * f;
            cells.push_back(offset);
            up_to.push_back(sum);
          }
      if (sum == 0.0) continue;
      // Samples are drawn with probability w^2 f; each contributes f(gamma x).
      RandomStream random(options.seed, i);
      std::vector<Eigen::Vector3d> drawn;
      for (int k = 0; k < options.num_samples; ++k) {
        const double target = (k + random.uniform()) * sum / options.num_samples;
        const auto at = std::min<std::size_t>(std::upper_bound(up_to.begin(), up_to.end(), target) - up_to.begin(),
                                              up_to.size() - 1);
        drawn.push_back(cells[at]);
      }
      for (const Eigen::Vector3d& normal : normals) {
        double total = 0.0;
        for (const Eigen::Vector3d& x : drawn) total += edt.atCell(p + x - 2.0 * normal.dot(x) * normal);
        result[i] = std::max(result[i], static_cast<float>(sum / sq_norm * total / options.num_samples));
      }
    }
  });
  return result;
}

}  // namespace pcl_symmetry
