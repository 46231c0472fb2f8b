#include "pictures/colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace pcl_symmetry::apps {

Eigen::Vector3d distinctColor(std::size_t index) {
  static const Eigen::Vector3d colors[] = {{0.90, 0.62, 0.00}, {0.00, 0.45, 0.70}, {0.00, 0.62, 0.45},
                                           {0.80, 0.47, 0.65}, {0.84, 0.37, 0.00}, {0.34, 0.71, 0.91},
                                           {0.94, 0.89, 0.26}, {0.35, 0.35, 0.35}};
  return colors[index % std::size(colors)];
}

Eigen::Vector3d segmentColor(int segment) {
  if (segment == kUnseenSegment) return {0.79, 0.70, 0.87};
  if (segment < 0) return Eigen::Vector3d::Constant(0.75);
  constexpr int kNumColors = 8;  // the colors of Okabe and Ito
  const double white = 1.0 - std::pow(0.65, segment / kNumColors);
  return (1.0 - white) * distinctColor(static_cast<std::size_t>(segment)) + white * Eigen::Vector3d::Ones();
}

Eigen::Matrix<std::uint8_t, 3, 1> bytesOf(const Eigen::Vector3d& color) {
  return (255.0 * color.array().max(0.0).min(1.0)).round().cast<std::uint8_t>();
}

Eigen::Vector3d cividis(double value) {
  static const std::array<std::uint32_t, 12> anchors = {0x00204D, 0x00306F, 0x2A406C, 0x48526B, 0x5E626E, 0x727374,
                                                        0x878479, 0x9E9677, 0xB6A971, 0xD0BE67, 0xEAD357, 0xFFEA46};
  const auto color = [](std::uint32_t code) -> Eigen::Vector3d {
    return Eigen::Vector3d((code >> 16) & 255, (code >> 8) & 255, code & 255) / 255.0;
  };
  if (!std::isfinite(value)) return segmentColor(kUnseenSegment);
  const double position = std::clamp(value, 0.0, 1.0) * (anchors.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(position), anchors.size() - 2);
  const double weight = position - static_cast<double>(lower);
  return (1 - weight) * color(anchors[lower]) + weight * color(anchors[lower + 1]);
}

}  // namespace pcl_symmetry::apps
