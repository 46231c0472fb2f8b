#include "evaluate/references/transform_candidates.h"

#include "core/geometry/principal_axes.h"
#include "pcl_symmetry/core/detection/local_maxima.h"
#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/transform/planar_transform.h"

namespace pcl_symmetry::apps {

namespace {

/// Least D of candidates. derived: a plane that maps 90 % of the area has a D far above; half only adds candidates.
constexpr double kLeastD = 0.3;
constexpr std::size_t kMostMaxima = 400;  // chosen: half misses planes of gears, twice takes twice the time

}  // namespace

std::vector<ReflectionPlane> transformCandidates(const Points& samples, const ReferenceOptions& options) {
  GaussianEdtOptions edt_options;
  edt_options.num_threads = options.num_threads;
  const GaussianEdt edt(samples, edt_options);
  const PlaneGrid grid(64, 256, 96, edt.center(), edt.radius());
  SampledTransformOptions map_options;
  map_options.num_samples = 512;
  map_options.num_threads = options.num_threads;
  map_options.seed = options.seed;
  const SymmetryMap map = sampledTransform(edt, grid, map_options);
  LocalMaximaOptions maxima_options;
  maxima_options.strength = maxima_options.laplacian = 0.0;
  maxima_options.num_threads = options.num_threads;
  std::vector<ReflectionPlane> planes = principalPlanes(principalAxes(samples));
  for (const LocalMaximum& maximum : findLocalMaxima(map, maxima_options))
    if (maximum.value >= kLeastD && planes.size() < kMostMaxima) planes.push_back(maximum.plane);
  return planes;
}

}  // namespace pcl_symmetry::apps
