#pragma once

#include <string>

namespace pcl_symmetry::detail {

/// Throws pcl::IOException "file: reason" and nothing else. (PCL puts " : " before its text.)
[[noreturn]] void failIO(const std::string& file, const std::string& reason);

}  // namespace pcl_symmetry::detail
