/// Planes of clouds of known meshes: what the detector sees of each, and how good it really is.
#pragma once

#include <string>
#include <vector>

#include "core/evidence/plane_confidence.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

/// One refined candidate.
struct EvidenceSample {
  std::string model, row;  ///< row: how the cloud was made
  PlaneEvidence evidence;
  double share;  ///< of the area of the mesh that the plane maps to within the tolerance of the mesh
};

/// The clouds that the decision is fitted to.
std::vector<CloudRecipe> calibrationRecipes();

/// \param tolerance share of the diameter.
/// \return the candidates of all clouds of the model.
std::vector<EvidenceSample> sampleEvidence(const Model& model, double tolerance);

/// \param i number of a shape of the tuning half, see foldedCloud().
/// \return the candidates of that cloud.
std::vector<EvidenceSample> sampleFoldedEvidence(int i, double tolerance);

}  // namespace pcl_symmetry::apps
