#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/matching/surface_points.h"
#include "core/matching/view_signature.h"

namespace pcl_symmetry::detail {

/// The parts of a model as bytes, in the order of all machines that PCL runs on: lowest byte first. Reading throws
/// std::invalid_argument if the bytes are not such a part.

/// For each matrix: its numbers of rows and columns, 32 bits each, and its values column by column.
/// \param matrices finite.
std::string packedMatrices(const std::vector<Eigen::MatrixXf>& matrices);
std::vector<Eigen::MatrixXf> unpackedMatrices(const std::string& bytes);

using PositionCloud = pcl::PointCloud<pcl::PointXYZ>;

/// \param cloud finite points.
std::string packedCloud(const PositionCloud& cloud);
PositionCloud unpackedCloud(const std::string& bytes);

std::string packedSignatures(const Eigen::MatrixXf& signatures);
Eigen::MatrixXf unpackedSignatures(const std::string& bytes);

std::string packedViews(const std::vector<View>& views);
std::vector<View> unpackedViews(const std::string& bytes);

std::string packedSurfaces(const std::vector<SurfacePoints>& surfaces);
std::vector<SurfacePoints> unpackedSurfaces(const std::string& bytes);

}  // namespace pcl_symmetry::detail
