/// The frame that all tools run in: errors become one line on standard error and an exit code.
#pragma once

#include <functional>

namespace pcl_symmetry::apps {

/// Runs the body of a tool and turns what it throws into one line on standard error and an exit code: 0 done (or what
/// the body returns), 1 could not be done, 2 wrong usage.
int runTool(int argc, char** argv, const std::function<int(int argc, char** argv)>& body);

}  // namespace pcl_symmetry::apps
