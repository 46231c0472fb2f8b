#include "pcl_symmetry/symmetry_maxima_refinement.h"

#include <limits>

#include "core/base/options.h"
#include "core/evidence/surface_samples.h"
#include "pcl_symmetry/core/published_planes.h"

namespace pcl_symmetry::detail {

Detection planesAsPublished(const Points& points, const GaussianEdt* edt, const SymmetryMap& map,
                            const DetectionOptions& options) {
  Detection found;
  std::optional<GaussianEdt> own;
  if (!edt) own.emplace(points, options.edtOptions());
  if (!edt) found.map = publishedMap(points, *own, TransformMethod::Convolution, options.seed, options.num_threads);
  auto published = optionsWith<PublishedOptions>(options.seed, options.num_threads);
  published.maxima = options.expert.maxima;
  published.num_points = options.expert.num_refine_samples;
  found.planes = publishedPlanes(points, edt ? *edt : *own, edt ? map : found.map, published);
  if (static_cast<int>(found.planes.size()) > options.max_planes) found.planes.resize(options.max_planes);
  return found;
}

std::vector<std::vector<float>> pointSupport(const SelectedPoints& all, std::size_t cloud_size, const Points& samples,
                                             const std::vector<ReflectionPlane>& planes, const Visibility* seen,
                                             int num_threads) {
  std::vector<std::vector<float>> support(planes.size(),
                                          std::vector<float>(cloud_size, std::numeric_limits<float>::quiet_NaN()));
  if (samples.cols() == 0) return support;
  const std::vector<std::vector<float>> finite = planeSupport(all.points, samples, planes, seen, num_threads);
  for (std::size_t k = 0; k < planes.size(); ++k)
    for (std::size_t i = 0; i < finite[k].size(); ++i) support[k][all.indices[i]] = finite[k][i];
  return support;
}

}  // namespace pcl_symmetry::detail
