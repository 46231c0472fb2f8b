// PCL's searches for closest points, compiled for the point types of the libraries. A program that links these does not
// load libpcl_search, libpcl_kdtree and their dependencies: 130 000 relocations for PCL's other point types, 40 ms at
// each start.
#include <pcl/point_types.h>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/search/impl/kdtree.hpp>
#include <pcl/search/impl/organized.hpp>
#include <pcl/search/impl/search.hpp>

#define PCL_SYMMETRY_COMPILE_SEARCHES(PointT) \
  template class pcl::KdTreeFLANN<PointT>;    \
  template class pcl::search::Search<PointT>; \
  template class pcl::search::KdTree<PointT>; \
  template class pcl::search::OrganizedNeighbor<PointT>;

PCL_SYMMETRY_COMPILE_SEARCHES(pcl::PointXYZ)
PCL_SYMMETRY_COMPILE_SEARCHES(pcl::PointNormal)
