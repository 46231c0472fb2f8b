#include "core/matching/shape_description.h"

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

/// At most \p max_points points, at equal steps in the input.
Points thinned(const PointsRef& points, int max_points) {
  if (points.cols() <= max_points) return points;
  Points kept(3, max_points);
  for (Eigen::Index i = 0; i < max_points; ++i) kept.col(i) = points.col(i * points.cols() / max_points);
  return kept;
}

}  // namespace

void DescriptionOptions::validate() const {
  check(max_points >= 2, "max_points", max_points, ">= 2");
  check(max_frame_points >= 2, "max_frame_points", max_frame_points, ">= 2");
  checkNumThreads(num_threads);
}

ShapeDescription describeShape(const PointsRef& points, const DescriptionOptions& options,
                               const Visibility* visibility) {
  options.validate();
  FrameOptions frame_options = signatureFrameOptions();
  frame_options.seed = options.seed;
  frame_options.num_threads = options.num_threads;
  ShapeDescription result;
  result.frame = symmetryFrame(thinned(points, options.max_frame_points), frame_options, visibility);
  const Points used = thinned(points, options.max_points);
  const std::vector<Eigen::Matrix3d> frames = signatureFrames(used, result.frame);
  result.signatures.resize(kSignatureSize, static_cast<Eigen::Index>(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::vector<float> signature = shapeSignature(used, frames[i]);
    result.signatures.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::VectorXf>(signature.data(), kSignatureSize);
  }
  return result;
}

}  // namespace pcl_symmetry
