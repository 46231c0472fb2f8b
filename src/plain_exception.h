/// Exceptions of PCL with the text as given: their own what() prepends " : ".
#pragma once

#include <string>

namespace pcl_symmetry::detail {

template <typename Exception>
class Plain : public Exception {
public:
  explicit Plain(const std::string& message) : Exception(message), message_(message) {}
  const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

}  // namespace pcl_symmetry::detail
