/// What pcl_symmetry_map measures: the symmetry of planes, of axes or of centers, mapped back to points.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line/common_options.h"
#include "io/input_shape.h"
#include "pcl_symmetry/core/point_set.h"
#include "pictures/picture.h"

namespace pcl_symmetry::apps {

struct SymmetryMeasure {
  std::string of;             ///< planes, axes or centers
  std::size_t num_tried = 0;  ///< number of these
  /// The greatest symmetry of what passes through each of 3 x N points, with a number of threads.
  std::function<std::vector<float>(const Points&, int)> through;
  std::vector<std::string> lines = {};            ///< the best of these, as printed
  nlohmann::json best = nlohmann::json::array();  ///< the same as JSON
  std::vector<AxisLine> axes = {};                ///< the best axes, for pictures
};

/// The measure of equation 1, PRST = sqrt((1 + D) / 2), in place of D. Estimates of D beyond [0, 1] count as its ends,
/// so that values lie within [0.707, 1].
SymmetryMeasure byEquation1(SymmetryMeasure measure);

/// What is measured.
struct MeasureOptions {
  std::string of = "planes";       ///< planes, axes or centers
  int fold = -1;                   ///< of axes: order of the turns, 0 = any angle; below 0: 2 to 8 and any angle
  std::string method = "sampled";  ///< of planes: the estimator, one of kMethodNames
  double scale = 0.0;              ///< of planes: radius of the window around each point, of the shape's; 0: the whole
};

/// \throws InputError where the input holds no answer.
SymmetryMeasure measureSymmetry(const InputShape& input, const CommonOptions& common, const MeasureOptions& options);

}  // namespace pcl_symmetry::apps
