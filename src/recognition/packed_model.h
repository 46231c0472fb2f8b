#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>
#include <vector>

#include "core/matching/view_signature.h"

namespace pcl_symmetry::detail {

/// The parts of a model as bytes. Reading throws std::invalid_argument where the bytes are no such part.

using PositionCloud = pcl::PointCloud<pcl::PointXYZ>;

/// Coordinates in steps of 1/65535 of the greatest extent: their error is at most 7.7e-6 of it. The order of the points
/// is lost: neighbours follow each other.
/// \param cloud finite points.
std::string packedCloud(const PositionCloud& cloud);
PositionCloud unpackedCloud(const std::string& bytes);

/// Values in steps of 1/127 of the greatest one of each column.
std::string packedSignatures(const Eigen::MatrixXf& signatures);
Eigen::MatrixXf unpackedSignatures(const std::string& bytes);

/// Values in steps of 1/96, rotations in steps of 1/32767.
std::string packedViews(const std::vector<View>& views);
std::vector<View> unpackedViews(const std::string& bytes);

}  // namespace pcl_symmetry::detail
