/// Where answers come from: our detector, or a file that another program wrote.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/planes/plane_matching.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

struct PlaneAnswers {
  std::vector<Answer> answers;         ///< centers, axes and planes, each best first
  std::optional<double> milliseconds;  ///< of the detection, where known
  bool failed = false;                 ///< no answer was given, not even "none"
};

/// Runs SymmetryMaximaRefinement with its defaults.
/// \param num_threads 0 = all.
/// \param tolerance of a symmetry, as a share of the diameter.
/// \return failed where it throws.
PlaneAnswers detectAnswers(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, std::uint64_t seed, int num_threads,
                           double tolerance = 0.01);

/// The same for an object of a scene.
/// \param cluster its points, indices into the scene.
/// \param seen what the scanner saw of the scene.
PlaneAnswers detectAnswers(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& scene, const pcl::Indices& cluster,
                           const SeenSpace::ConstPtr& seen, std::uint64_t seed, int num_threads);

/// Reads folder/name.json, as pcl_symmetry_planes writes it, or else folder/name.txt with a line `a b c d [score]` for
/// each plane a x + b y + c z + d = 0, best first, # comments. The confidence, or else the score, ranks answers; where
/// neither is given, their order does, and all of them are called symmetries.
/// \return failed where neither file exists.
/// \throws InputError for a file that cannot be understood.
PlaneAnswers readAnswers(const std::string& folder, const std::string& name);

}  // namespace pcl_symmetry::apps
