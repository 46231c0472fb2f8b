#pragma once

#include <cstddef>
#include <vector>

namespace pcl_symmetry {

/// The picture of a depth camera, row by row.
struct DepthImage {
  int width, height;          ///< >= 1
  std::vector<float> depths;  ///< along the forward axis, > 0; NaN or infinite where the pixel holds no point
  double pixel_angle;         ///< between neighboring pixels, radians, > 0
};

struct FilteredDepths {
  std::vector<float> depths;   ///< NaN where the input has none, and at flying pixels
  std::size_t num_flying = 0;  ///< pixels that were taken out
  double inverse_error = 0.0;  ///< standard deviation of the errors of the inverse depths that were taken out
};

/// Errors of the inverse depths, from what neighbors on slanted planes cannot explain: there, inverse depths grow
/// evenly from pixel to pixel. Errors of stereo and of structured light are the same for all inverse depths.
/// \param apart pixels between those that are compared, >= 1.
/// \return standard deviation, units of the inverse depths; 0 for fewer than three pixels in line, and where the shape
/// bends by more between neighbors.
double inverseDepthError(const DepthImage& image, int apart = 1);

/// Takes the errors of a depth camera out of its picture.
///
/// Each depth becomes that of the plane through the pixels around it, fitted to their inverse depths: those of a
/// slanted plane grow evenly from pixel to pixel. Pixels of other surfaces do not count, so that edges stay. A pixel
/// that hardly any neighbor agrees with is a flying one, between two surfaces, and is left out. Pictures without errors
/// stay as they are, as do pictures whose pixels share errors with their neighbors (stereo, structured light): their
/// mean would keep the errors and round edges.
/// \param radius of the square around a pixel, pixels, >= 1.
FilteredDepths filterDepths(const DepthImage& image, int radius, int num_threads);

/// Errors of the inverse depths of a camera, from its picture alone.
///
/// inverseDepthError() sees what differs between neighbors. Pixels share most of their error with their neighbors, as
/// stereo and structured light match windows of pixels.
/// \return standard deviation of the whole error, units of the inverse depths.
double sensorError(const DepthImage& image);

}  // namespace pcl_symmetry
