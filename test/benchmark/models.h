/// The five models that the benchmarks run on.
#pragma once

#include <string>
#include <vector>

#include "pcl_symmetry/core/point_set.h"

namespace pcl_symmetry::benchmarks {

/// What a scanner sees of a surface.
struct Scan {
  Points points;
  Eigen::Vector3d viewpoint;
};

/// A surface that points can be sampled from.
struct Model {
  std::string name;
  Points vertices;
  std::vector<Eigen::Vector3i> triangles;

  Points sample(int num_points) const;

  /// What is seen of that many samples from four radii away: the nearest one in each pixel.
  Scan scan(int num_points) const;
};

/// Reads an OFF file of polygons, which are cut into triangles.
/// \throws std::runtime_error naming the file and what is wrong with it.
Model readOff(const std::string& file);

/// bull, cow, elephant, hand and camel of CGAL's demo data in \p folder; five synthetic shapes where \p folder is
/// empty.
std::vector<Model> fiveModels(const std::string& folder);

}  // namespace pcl_symmetry::benchmarks
