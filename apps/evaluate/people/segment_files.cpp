#include "evaluate/people/segment_files.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

std::vector<std::string> segmentFilesOf(const std::string& folder, const std::string& model) {
  std::vector<std::string> paths;
  const fs::path own = fs::path(folder) / model;
  const bool has_own = fs::is_directory(own);
  for (const fs::directory_entry& entry : fs::directory_iterator(has_own ? own : fs::path(folder))) {
    const fs::path& path = entry.path();
    if (path.extension() != ".seg") continue;
    if (has_own || boost::starts_with(path.stem().string(), model + "_")) paths.push_back(path.string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace pcl_symmetry::apps
