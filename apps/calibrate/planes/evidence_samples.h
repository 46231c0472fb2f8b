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
  double share;       ///< of the area of the mesh that the plane maps to within the tolerance of the mesh
  double near_share;  ///< the greatest share of the planes that could not be told from this one
  int rank;           ///< by merit among the planes of its cloud, from 0
};

/// The clouds that the decision is fitted to.
std::vector<CloudRecipe> calibrationRecipes();

/// \param tolerance share of the diameter.
/// \return the candidates of all clouds of the model; those of one cloud differ by more than answers that are merged.
std::vector<EvidenceSample> sampleEvidence(const Model& model, double tolerance);

/// \param i number of a shape of the tuning half, see foldedCloud().
/// \return the candidates of that cloud.
std::vector<EvidenceSample> sampleFoldedEvidence(int i, double tolerance);

/// A row for each sample, from which evidenceFromTable() makes the very same sample.
std::string evidenceTable(const std::vector<EvidenceSample>& samples);

/// \throws InputError naming the file and the line.
std::vector<EvidenceSample> readEvidenceTable(const std::string& path);

}  // namespace pcl_symmetry::apps
