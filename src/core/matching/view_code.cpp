#include "core/matching/view_code.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace pcl_symmetry {

namespace {

template <typename Integer>
Integer inSteps(double value, double step) {
  const double least = std::numeric_limits<Integer>::min(), greatest = std::numeric_limits<Integer>::max();
  return static_cast<Integer>(std::lround(std::clamp(value / step, least, greatest)));
}

}  // namespace

std::string packedViewCodes(const std::vector<ViewCode>& codes) {
  std::string bytes;
  bytes.reserve((kViewCodeSize + 2) * codes.size());
  for (std::size_t k = 0; k < kViewCodeSize; ++k)
    for (const ViewCode& code : codes) bytes.push_back(static_cast<char>(code.values[k]));
  for (const ViewCode& code : codes) {
    const auto size = static_cast<std::uint16_t>(code.size);
    bytes.push_back(static_cast<char>(size & 0xff));
    bytes.push_back(static_cast<char>(size >> 8));
  }
  return bytes;
}

ViewCoder ViewCoder::fit(const std::vector<View>& views) {
  check(!views.empty(), "number of views", static_cast<double>(views.size()), ">= 1");
  Eigen::MatrixXd magnitudes(kTurnlessViewSize, static_cast<Eigen::Index>(views.size()));
  for (std::size_t i = 0; i < views.size(); ++i)
    magnitudes.col(static_cast<Eigen::Index>(i)) = turnlessValues(views[i].values).cast<double>();
  const Eigen::VectorXd mean = magnitudes.rowwise().mean();
  magnitudes.colwise() -= mean;
  const Eigen::MatrixXd products = magnitudes * magnitudes.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  ViewCoder coder;
  coder.mean_ = mean.cast<float>();
  coder.basis_ = solver.eigenvectors().rowwise().reverse().leftCols(kViewCodeSize).cast<float>();
  return coder;
}

ViewCode ViewCoder::codeOf(const View& view) const {
  const Eigen::VectorXf components = basis_.transpose() * (turnlessValues(view.values) - mean_);
  ViewCode code;
  for (int k = 0; k < kViewCodeSize; ++k)
    code.values[static_cast<std::size_t>(k)] =
        inSteps<std::int8_t>(static_cast<double>(components[k]), static_cast<double>(kViewCodeStep));
  code.size = inSteps<std::int16_t>(std::log(view.radius), static_cast<double>(kViewSizeStep));
  return code;
}

std::string ViewCoder::codesOf(const std::vector<View>& views) const {
  std::vector<ViewCode> codes;
  codes.reserve(views.size());
  for (const View& view : views) codes.push_back(codeOf(view));
  return packedViewCodes(codes);
}

Eigen::MatrixXf ViewCoder::toValues() const {
  Eigen::MatrixXf values(kTurnlessViewSize, 1 + kViewCodeSize);
  values << mean_, basis_;
  return values;
}

ViewCoder ViewCoder::fromValues(const Eigen::MatrixXf& values) {
  check(values.rows() == kTurnlessViewSize && values.cols() == 1 + kViewCodeSize, "size of a view coder",
        static_cast<double>(values.size()), "that of this library");
  ViewCoder coder;
  coder.mean_ = values.col(0);
  coder.basis_ = values.rightCols(kViewCodeSize);
  return coder;
}

}  // namespace pcl_symmetry
