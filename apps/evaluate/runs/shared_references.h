/// Reference symmetries of models, searched by the processes of a run.
#pragma once

#include <vector>

#include "common/command_line/console.h"
#include "evaluate/references/reference_cache.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shared/model_list.h"

namespace pcl_symmetry::apps {

/// Searches the symmetries of all models that the cache does not know; then the caches of all processes know them, and
/// the first one has saved its own. Models that cannot be used stay unknown.
void shareReferences(const std::vector<Model>& models, const ReferenceOptions& options, ReferenceCache& cache,
                     ResumableRun& work, const Console& console);

}  // namespace pcl_symmetry::apps
