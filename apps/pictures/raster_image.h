/// Pictures as arrays of pixels, read from PNG and binary PGM and written as PNG; values on a box of cells, for
/// ParaView and other viewers of volumes. No display is needed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// Red, green and blue, 8 bits each, row by row from the top.
struct RasterImage {
  RasterImage() = default;
  /// Makes a white picture.
  /// \param num_columns,num_rows pixels, >= 1.
  RasterImage(int num_columns, int num_rows)
      : width(num_columns), height(num_rows), pixels(3 * std::size_t(num_columns) * num_rows, 255) {}

  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  std::uint8_t* at(int x, int y) { return &pixels[3 * (std::size_t(y) * width + x)]; }
  const std::uint8_t* at(int x, int y) const { return &pixels[3 * (std::size_t(y) * width + x)]; }

  /// \param color red, green and blue in [0, 1], clamped.
  void set(int x, int y, const Eigen::Vector3d& color);

  /// Fills a disk, at least the pixel of its center; what lies outside the picture is left out.
  /// \param center pixels, (0, 0) = middle of the first one.
  void drawDisk(const Eigen::Vector2d& center, double radius, const Eigen::Vector3d& color);
};

/// Pictures of one size in rows, separated by white gaps.
/// \param num_columns 0 = one row.
RasterImage sideBySide(const std::vector<RasterImage>& tiles, int num_columns = 0);

/// Gray pictures get three equal channels, transparent ones a white background.
/// \throws InputError for a file that is no PNG or binary PGM picture of 8 or 16 bits.
RasterImage readImage(const std::string& path);

/// Writes a complete PNG.
/// \throws InputError if the file cannot be written.
void writeImage(const RasterImage& image, const std::string& path);

struct VolumeImage {
  std::string name;           ///< name of the values
  Eigen::Array3i size;        ///< cells along x, y and z
  Eigen::Vector3d origin;     ///< center of cell (0, 0, 0), input frame
  double cell_size;           ///< edge of a cell, input units
  std::vector<float> values;  ///< one value per cell, x fastest
};

/// Writes a complete VTK image (.vti).
/// \throws InputError if the file cannot be written.
void writeVolume(const VolumeImage& volume, const std::string& path);

}  // namespace pcl_symmetry::apps
