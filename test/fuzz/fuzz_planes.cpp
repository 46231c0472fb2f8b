/// Planes, axes, centers and rotations of arbitrary points, as a whole cloud and as a scan.
#include <stdexcept>

#include "fuzz/byte_source.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/symmetry_frame.h"

namespace {

using namespace pcl_symmetry;

/// A coarse search: what is looked for are wrong accesses, not exact planes.
DetectionOptions quickOptions(fuzz::ByteSource& source) {
  DetectionOptions options;
  options.num_cells = 8 + source.below(9);
  options.expert.num_theta = 1 + source.below(8);
  options.expert.num_phi = 2 + 2 * source.below(8);
  options.expert.num_radius = 1 + source.below(8);
  options.expert.num_samples = 1 + source.below(16);
  options.expert.max_candidates = 1 + source.below(4);
  options.expert.num_refine_samples = 10 + source.below(90);
  options.approximate = source.flag();
  options.rotations = source.flag();
  options.num_threads = 1;
  return options;
}

void checkPlane(const SymmetryPlane& plane, const DetectionOptions& options, std::size_t num_points) {
  FUZZ_CHECK(std::abs(plane.normal().norm() - 1.0) < 1e-6);
  FUZZ_CHECK(std::isfinite(plane.offset()));
  FUZZ_CHECK(fuzz::isShare(plane.confidence) && fuzz::isShare(plane.support) && fuzz::isShare(plane.share));
  FUZZ_CHECK(plane.kind != PlaneKind::Symmetry || plane.confidence >= options.min_confidence);
  FUZZ_CHECK(plane.point_support.size() <= num_points);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteSource source(data, size);
  const DetectionOptions options = quickOptions(source);
  const bool is_scan = source.flag();
  const Eigen::Vector3d viewpoint =
      10.0 * Eigen::Vector3d(source.take<std::int8_t>(), source.take<std::int8_t>(), source.take<std::int8_t>());
  const Points points = fuzz::takePoints(source, 300);
  try {
    const std::optional<Visibility> seen = is_scan ? Visibility::fromPoints(points, viewpoint) : std::nullopt;
    const Detection detection = detectPlanes({points, seen ? &*seen : nullptr}, options);
    FUZZ_CHECK(points.allFinite());
    FUZZ_CHECK(static_cast<int>(detection.planes.size()) <= options.max_planes);
    for (const SymmetryPlane& plane : detection.planes)
      checkPlane(plane, options, static_cast<std::size_t>(points.cols()));
    for (const SymmetryAxis& axis : detection.axes)
      FUZZ_CHECK(axis.point.allFinite() && std::abs(axis.direction.norm() - 1.0) < 1e-6 &&
                 fuzz::isShare(axis.confidence));
    for (const SymmetryCenter& center : detection.centers)
      FUZZ_CHECK(center.point.allFinite() && fuzz::isShare(center.confidence));
  } catch (const std::invalid_argument&) {
    FUZZ_CHECK(!points.allFinite() || is_scan);
  }
  return 0;
}
