#include "core/refinement/normalized_cloud.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "core/geometry/closest_points.h"
#include "core/geometry/cloud_extent.h"
#include "core/refinement/refinement_rules.h"
#include "core/transform/sampled_transform.h"

namespace pcl_symmetry {

namespace {

/// Replaces estimated normals by normals of the input.
LocalGeometry withNormals(LocalGeometry geometry, const Points* given) {
  for (Eigen::Index i = 0; given && i < given->cols(); ++i) {
    const float length = given->col(i).norm();
    if (std::isfinite(length) && length > 0.0f) geometry.normals.col(i) = given->col(i) / length;
  }
  return geometry;
}

/// The dimension that points fill within their neighborhoods, by maximum likelihood (Levina and Bickel 2004): 1 for a
/// wire, 2 for a surface, 3 for a volume.
double localDimension(const Points& points, const FoundNeighbors& neighbors) {
  const std::size_t size = neighbors.sq_reach.size(), count = neighbors.indices.size() / std::max<std::size_t>(1, size);
  double sum = 0.0;
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t k = i * count + 1; k + 1 < (i + 1) * count; ++k) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(neighbors.indices[k]);
      const float sq_distance = (points.col(a) - points.col(b)).squaredNorm();
      sum += std::log(neighbors.sq_reach[i] / std::max(sq_distance, 1e-12f));
    }
  return 2.0 * static_cast<double>(size) * (static_cast<double>(count) - 2.0) / std::max(sum, 1e-6);
}

}  // namespace

NormalizedCloud::NormalizedCloud(const PointsRef& input, const GaussianEdt& edt_of_input,
                                 ClosestPointSearch::Ptr input_search, const Visibility* seen, int num_threads,
                                 const Points* given_normals)
    : edt(edt_of_input),
      center(edt.center()),
      scale(edt.radius()),
      points(normalizePoints(input, center, scale)),
      flann(input_search ? nullptr : std::make_shared<FlannSearch>(points)),
      search(input_search ? std::move(input_search) : flann),
      geometry(withNormals(localGeometry(points, *search, num_threads, &neighbors), given_normals)),
      lists(NeighborLists::isUseful(points.cols())
                ? std::make_shared<NeighborLists>(points, neighbors.indices, neighbors.sq_reach)
                : nullptr),
      samples(surfaceSamples(points, geometry, num_threads)),
      visibility(seen ? std::optional<Visibility>(seen->normalized(center, scale)) : std::nullopt),
      far(edt, center, scale),
      surface{points,
              geometry.normals,
              *search,
              seen ? &geometry.at_border : nullptr,
              &far,
              num_threads,
              visibility ? &*visibility : nullptr},
      walk(lists ? std::make_unique<NeighborWalk>(*lists, *search) : nullptr),
      quick_surface{points, geometry.normals, walk ? *walk : *search, surface.at_border,
                    &far,   num_threads,      surface.visibility},
      principal_axes(principalAxes(points)),
      diameter(approximateDiameter(points)),
      spacing(median(geometry.spacing)),
      roughness(median(geometry.roughness) / std::max(spacing, 1e-6)),
      baseline(std::max(mean(ownSupport(samples, num_threads)), 1e-3)),
      sigma(edt.sigma() / scale),
      final_sigma(std::min(sigma, std::max(1e-6, kRefinement.final_sigma_in_spacings * spacing))),
      kind_(visibility ? CloudKind::Scan
            : roughness > kRefinement.volume_roughness &&
                    localDimension(points, neighbors) > kRefinement.volume_dimension
                ? CloudKind::Volume
                : CloudKind::Surface) {
  static_assert(kNumSupportNeighbors == NeighborLists::kNeighbors);
  if (flann) flann->use(lists);
}

ReflectionPlane NormalizedCloud::toInput(const ReflectionPlane& plane) const {
  return ReflectionPlane(plane.normal(), plane.offset() * scale + plane.normal().dot(center));
}

double NormalizedCloud::score(const ReflectionPlane& input_plane) const {
  return correlation(edt, input_plane, surface.num_threads);
}

}  // namespace pcl_symmetry
