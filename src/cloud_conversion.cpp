#include <pcl/console/print.h>
#include <pcl/point_types.h>

#include <algorithm>

#include "core/base/check.h"
#include "core/geometry/point_samples.h"
#include "core/geometry/usable_points.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry::detail {

namespace {

/// pcl::BadArgumentException puts " : " before its text.
class PlainBadArgument : public pcl::BadArgumentException {
public:
  explicit PlainBadArgument(const std::string& message) : pcl::BadArgumentException(message), message_(message) {}
  const char* what() const noexcept override { return message_.c_str(); }

private:
  std::string message_;
};

}  // namespace

void throwBadArgument(const std::string& message) {
  throw PlainBadArgument(message);
}

void checkAtLeast(const char* field, std::int64_t value, std::int64_t least) {
  const std::string rule = ">= " + std::to_string(least);
  withBadArguments([&] { check(value >= least, field, value, rule.c_str()); });
}

std::string reasonForNoAnswer(const Points& points, const std::string& input, int min_points,
                              const pcl::Indices* indices) {
  std::string reason = points.cols() > 0             ? whyUnanswerable(points)
                       : indices && indices->empty() ? "the indices are empty"
                       : indices                     ? "no finite point among the indices"
                                                     : "no finite point";
  if (reason.empty() && points.cols() < min_points)
    reason = std::to_string(points.cols()) + " points, must be at least " + std::to_string(min_points);
  return reason.empty() ? reason : input + ": " + reason;
}

void warnOfNoAnswer(const std::string& source, const std::string& reason) {
  PCL_WARN("[pcl_symmetry::%s] %s.\n", source.c_str(), reason.c_str());
}

std::vector<std::size_t> drawOneOfEachRun(std::size_t num_points, std::size_t max_points, std::uint64_t seed) {
  return oneOfEachRun(num_points, max_points, seed);
}

Eigen::Vector4d unitPlane(const Eigen::Vector4d& coefficients) {
  const double length = coefficients.head<3>().norm();
  if (!(length > 0.0) || !coefficients.allFinite())
    throwBadArgument("ground: must be four finite numbers A,B,C,D, not all of A, B, C zero");
  return coefficients / length;
}

}  // namespace pcl_symmetry::detail
