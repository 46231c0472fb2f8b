#pragma once

#include <cstddef>
#include <vector>

namespace pcl_symmetry {

/// A depth image, row by row.
struct DepthImage {
  int width, height;          ///< pixels, >= 1
  std::vector<float> depths;  ///< depths along the forward axis, > 0; NaN or infinite where the pixel holds no point
  double pixel_angle;         ///< angle between neighboring pixels, radians, > 0
};

struct FilteredDepths {
  std::vector<float> depths;   ///< NaN where the input has no depth, and at flying pixels
  std::size_t num_flying = 0;  ///< number of flying pixels that were removed
  double inverse_error = 0.0;  ///< standard deviation of the removed errors of the inverse depths
};

/// Errors of the inverse depths: deviations from locally slanted planes, on which inverse depths change linearly from
/// pixel to pixel. Errors of stereo and of structured light are the same for all inverse depths.
/// \param apart distance between the pixels that are compared, pixels, >= 1.
/// \return standard deviation, units of the inverse depths; 0 for fewer than three pixels in a line, and if the shape
/// bends by more between neighbors.
double inverseDepthError(const DepthImage& image, int apart = 1);

/// Removes the errors of a depth camera from its depth image.
///
/// Each depth is replaced by the depth of a plane fitted to the inverse depths of the pixels around it, which change
/// linearly on a slanted plane. Pixels of other surfaces do not count, so that edges stay. A pixel with which hardly
/// any neighbor agrees is a flying pixel between two surfaces and is removed. Images without errors stay unchanged, as
/// do images whose pixels share errors with their neighbors (stereo, structured light): averaging would keep the errors
/// and round the edges.
/// \param radius half the side of the square around a pixel, pixels, >= 1.
FilteredDepths filterDepths(const DepthImage& image, int radius, int num_threads);

/// Errors of the inverse depths of a camera, from its depth image alone.
///
/// inverseDepthError() measures differences between neighbors, but pixels share most of their error with their
/// neighbors, as stereo and structured light match windows of pixels.
/// \return standard deviation of the whole error, units of the inverse depths.
double sensorError(const DepthImage& image);

}  // namespace pcl_symmetry
