#include "recognition/io_error.h"

#include <pcl/exceptions.h>

namespace pcl_symmetry::detail {

namespace {

class PlainIOException : public pcl::IOException {
public:
  explicit PlainIOException(const std::string& message) : pcl::IOException(message), message_(message) {}
  const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

}  // namespace

void failIO(const std::string& file, const std::string& reason) {
  throw PlainIOException(file + ": " + reason);
}

}  // namespace pcl_symmetry::detail
