// PCL's classes for the segmentation of scenes, compiled for the library's point type: see search_classes.cpp.
#include <pcl/point_types.h>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>
#include <pcl/segmentation/impl/extract_clusters.hpp>
#include <pcl/segmentation/impl/lccp_segmentation.hpp>
#include <pcl/segmentation/impl/supervoxel_clustering.hpp>

namespace pcl::octree {

// The voxels of XYZ points, represented by their mean point: PCL's library has them as specializations.
using XYZVoxel = OctreePointCloudAdjacencyContainer<PointXYZ, SupervoxelClustering<PointXYZ>::VoxelData>;

template <>
void XYZVoxel::addPoint(const PointXYZ& point) {
  ++num_points_;
  data_.xyz_ += point.getVector3fMap();
}

template <>
void XYZVoxel::computeData() {
  data_.xyz_ /= static_cast<float>(num_points_);
}

}  // namespace pcl::octree

template class pcl::PCLBase<pcl::PointXYZ>;
template class pcl::RandomSampleConsensus<pcl::PointXYZ>;
template class pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
template class pcl::EuclideanClusterExtraction<pcl::PointXYZ>;
template class pcl::SupervoxelClustering<pcl::PointXYZ>;
template class pcl::LCCPSegmentation<pcl::PointXYZ>;
