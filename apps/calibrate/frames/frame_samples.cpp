#include "calibrate/frames/frame_samples.h"

#include "common/shape_input/shape_input.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/frames/frame_difference.h"
#include "pcl_symmetry/impl/cloud_analysis.hpp"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry::apps {

namespace {

constexpr double kRightFrame = 5.0;  // degrees. derived: probable_frames.h

/// The points of a cloud and what was seen, as SymmetryAlignment has them.
class FrameInput : public ScanAnalysis<pcl::PointXYZ> {
public:
  explicit FrameInput(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud)
      : ScanAnalysis<pcl::PointXYZ>("FrameInput", 50'000) {
    setInputCloud(cloud);
    points = selectInput(FrameOptions().seed);
    if (points.cols() > 0) seen = seenSpace(points);
  }

  Points points;
  std::optional<Visibility> seen;
};

FrameSample sampleOf(const TestCloud& cloud) {
  const FrameInput input(cloud.cloud);
  FrameSample sample;
  sample.scanned = input.seen.has_value();
  if (input.points.cols() == 0) return sample;
  FrameOptions options;
  options.num_threads = options.edt.num_threads = 1;
  const PointsRef points(input.points);
  const FrameEvidence evidence(points, options, input.seen ? &*input.seen : nullptr);
  const FoundFrames found = findFrames(evidence, options, [](const char*) {});
  sample.choices = frameChoices(evidence, found.refined, options.tie, options.num_threads);
  for (const FrameChoice& choice : sample.choices) {
    Eigen::Matrix3d axes = choice.frame.axes.cast<double>();
    if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
    const Eigen::Matrix3d own = cloud.T_cloud_model.linear();
    sample.right.push_back(angleOfAxes(own, axes, choice.revolution_axis) < kRightFrame);
  }
  return sample;
}

}  // namespace

std::vector<FrameSample> sampleFrames(const Model& model, int num_views) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) throw InputError(model.path + ": has no faces");
  TestCloudOptions options;
  options.noise = {0.0};
  options.num_views = num_views;
  const TestCloudMaker maker(*shape.mesh, model.key, options);
  std::vector<FrameSample> samples;
  for (const CloudRecipe& recipe : recipesFor(options)) samples.push_back(sampleOf(maker.make(recipe)));
  return samples;
}

}  // namespace pcl_symmetry::apps
