/// What an evaluation of planes finds out about one model, and its way from one process to another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/planes/plane_statistics.h"
#include "evaluate/references/reference_symmetries.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

struct ModelResult {
  std::optional<SymmetryKind> kind;  ///< none where the model could not be used
  int num_clouds = 0;
  std::vector<CloudResult> clouds;                      ///< those in which planes were looked for
  std::vector<std::string> left_out;                    ///< why clouds, or the model, could not be used
  std::optional<ReferenceSymmetries> found_references;  ///< where they were not known before
  std::size_t num_faces = 0;                            ///< of the mesh of these references
  std::string ground_truth;                             ///< JSON of the exported clouds, or nothing
};

/// Of answers their scores and judgements go along, not where they are.
std::string packedResult(const ModelResult& result, const std::vector<CloudRecipe>& recipes);

/// \param recipes as packedResult() had them.
/// \throws std::invalid_argument for other bytes.
ModelResult unpackedResult(const std::string& bytes, const std::vector<CloudRecipe>& recipes);

// One cloud of it.
void put(detail::PackedBytes& bytes, const CloudResult& cloud, const std::vector<CloudRecipe>& recipes);
CloudResult cloudFrom(detail::UnpackedBytes& bytes, const std::vector<CloudRecipe>& recipes);

}  // namespace pcl_symmetry::apps
