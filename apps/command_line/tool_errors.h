/// What stops a tool, and the exit code that each reason stands for.
#pragma once

#include <stdexcept>
#include <string>

namespace pcl_symmetry::apps {

/// A file or its content that a tool cannot work with, or a result that cannot be written: exit code 1. The message is
/// one line and names the file, the field, the value and the rule.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A command line that does not make sense: exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace pcl_symmetry::apps
