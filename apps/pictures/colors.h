/// The colors of planes, parts and support in pictures and pages.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace pcl_symmetry::apps {

/// Eight colors that color-blind readers distinguish (Okabe and Ito), repeated from the start when they run out.
Eigen::Vector3d distinctColor(std::size_t index);

/// Segment of points for which the scanner could not see whether they support a plane.
constexpr int kUnseenSegment = -2;

/// The color of a segment: distinct colors, lighter with each round; violet for kUnseenSegment, gray for others below
/// 0.
Eigen::Vector3d segmentColor(int segment);

/// \param color red, green and blue in [0, 1], clamped.
/// \return 8 bits each.
Eigen::Matrix<std::uint8_t, 3, 1> bytesOf(const Eigen::Vector3d& color);

/// \param value in [0, 1], clamped.
/// \return its color on the cividis scale (dark blue to yellow); violet for NaN.
Eigen::Vector3d cividis(double value);

}  // namespace pcl_symmetry::apps
