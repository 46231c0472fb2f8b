/// Runs the analysis of a tool on one input or on many.
///
/// One input: text on standard output, JSON and CSV in files. Several: one line of JSON for each, in the order of the
/// inputs, as soon as it is known; inputs side by side on all threads; an input that fails has a line with "error", is
/// named again at the end, and does not stop the others. Memory does not grow with the number of inputs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command_line/batch_options.h"
#include "command_line/file_job.h"
#include "command_line/common_options.h"

namespace pcl_symmetry::apps {

/// \param columns of the CSV table, after "file".
/// \param analyse called once for each input, from several threads at once; throws what stops this input.
/// \return exit status of the tool: 1 if an input failed.
/// \throws what the analysis of a single input throws; UsageError where outputs of several inputs would have one name;
/// InputError where results cannot be written.
int runOnFiles(const BatchOptions& batch, const CommonOptions& common, const std::vector<std::string>& columns,
               const std::function<void(FileJob&)>& analyse);

}  // namespace pcl_symmetry::apps
