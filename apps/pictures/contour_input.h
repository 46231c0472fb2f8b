/// Planar shapes from files: points of a cloud, or what a picture shows.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <string>

#include "pictures/raster_image.h"

namespace pcl_symmetry::apps {

/// The pixels of a picture that do not belong to the ground, at (x, height - 1 - y, 0) in pixels. The ground is what
/// most pixels at the border are, dark or light (of two halves of the range).
/// \param filled every such pixel; otherwise those beside the ground or the border: the outline.
/// \throws InputError where there is none.
/// \param name of the picture in the error.
pcl::PointCloud<pcl::PointXYZ>::Ptr contourOfImage(const RasterImage& image, bool filled, const std::string& name);

/// \param path a picture (.png, .pgm) or a cloud that loadShape() reads.
/// \throws InputError naming the file, what is wrong and the rule.
pcl::PointCloud<pcl::PointXYZ>::Ptr loadContour(const std::string& path, bool filled);

}  // namespace pcl_symmetry::apps
