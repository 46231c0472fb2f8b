/// Do stated probabilities of rotations come true on meshes, and are groups the same for any number of points?
#pragma once

#include "evaluate/rotations/rotation_options.h"
#include "evaluate/runs/resumable_run.h"

namespace pcl_symmetry::apps {

/// Groups and rejected turns of clouds of whole meshes.
void evaluateMeshGroups(const EvaluateRotationsOptions& options, ResumableRun& work);

/// Turns of single scans of meshes, or without any of the solids of `shapes turns -half report`.
void evaluateScanTurns(const EvaluateRotationsOptions& options, ResumableRun& work);

}  // namespace pcl_symmetry::apps
