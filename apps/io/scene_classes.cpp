// PCL's classes that part a scene, compiled for its point type: see search_classes.cpp.
#include <pcl/point_types.h>
#include <pcl/sample_consensus/impl/ransac.hpp>
#include <pcl/sample_consensus/impl/sac_model_plane.hpp>
#include <pcl/segmentation/impl/extract_clusters.hpp>

template class pcl::RandomSampleConsensus<pcl::PointXYZ>;
template class pcl::SampleConsensusModelPlane<pcl::PointXYZ>;
template class pcl::EuclideanClusterExtraction<pcl::PointXYZ>;
