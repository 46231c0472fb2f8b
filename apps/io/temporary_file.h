/// Files that are gone when they are no longer needed, however the program ends.
#pragma once

#include <string>

namespace pcl_symmetry::apps {

/// Removes the file when it goes out of scope, or when SIGINT, SIGTERM or SIGHUP ends the program.
class TemporaryFile {
public:
  explicit TemporaryFile(const std::string& name);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& name() const { return name_; }

private:
  std::string name_;
  int slot_ = -1;  ///< among the names that a signal handler removes
};

/// Makes an empty file of a name that no other has.
/// \param model with % signs, each replaced by a random digit.
/// \return its name; empty where it cannot be made, errno then says why.
std::string makeUniqueFile(const std::string& model);

}  // namespace pcl_symmetry::apps
