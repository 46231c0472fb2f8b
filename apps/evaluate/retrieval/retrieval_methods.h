/// Ways to tell how alike shapes are: the descriptors that the paper compares (Section 5.2), and this library's.
#pragma once

#include <pcl/PolygonMesh.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluate/retrieval/model_forms.h"

namespace pcl_symmetry::apps {

struct RetrievalOptions {
  int num_references = 200;  ///< models, drawn whatever their class, that compact forms and scaling are made from
  int num_nearest = 10;      ///< of these that a model's typical distance is taken from
  std::uint64_t seed = 0;
  int num_threads = 0;
};

struct RetrievalMethod {
  std::string name;
  Eigen::MatrixXf distances;  ///< N x N, symmetric
  bool charted = true;        ///< has a curve of its own in the charts
};

/// Told the share of the work that is done, in [0, 1].
using RetrievalProgress = std::function<void(double)>;

/// PRSD, PRST, GEDT and the product of the latter two: L2 in one frame each, about the center of mass; and PRSD by the
/// greatest difference, as Kazhdan et al. (2004) compare it; and PRST and the product with values by equation 1.
std::vector<RetrievalMethod> publishedMethods(const std::vector<SymmetryDescriptors>& models, ModelAxes axes,
                                              const RetrievalOptions& options);

/// PRST and GEDT in forms that turn, and signatures, in the best of all rotations of axes; their compact forms; and all
/// these with distances scaled by those to the references. The product of PRST and GEDT, in the best rotation of both.
std::vector<RetrievalMethod> signatureMethods(std::vector<TurnableForms> models, const RetrievalOptions& options,
                                              const RetrievalProgress& progress);

/// SymmetryDatabase::match(): each cloud, turned once more at random, asks a database of all.
RetrievalMethod databaseMethod(const std::vector<Points>& clouds, const RetrievalOptions& options,
                               const RetrievalProgress& progress);

}  // namespace pcl_symmetry::apps
