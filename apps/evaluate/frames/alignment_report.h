/// What `pcl_symmetry_evaluate alignment` prints and writes.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/frames/alignment_methods.h"
#include "evaluate/shared/proportion.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

/// A frame against the truth; angles in degrees.
struct FrameErrors {
  std::string model;
  int view = -1;  ///< -1: the whole cloud
  AlignmentMethod method = AlignmentMethod::Symmetry;
  double own_angle = 0.0;         ///< of the axes from the model's own coordinate axes, any order and sign
  double own_turned_angle = 0.0;  ///< and any angle about the model's axis of revolution
  double center = 0.0;            ///< of a scan's center from that of the whole, diagonals
  double axes_angle = 0.0;        ///< of a scan's axes from those of the whole, any order and sign
  double frame_angle = 0.0;       ///< of a scan's frame from that of the whole, or one that is equally good
  double equal_axes_angle = 0.0;  ///< the same, any order and sign
  /// Of a scan's axes from those of the whole, up to the symmetries of the mesh; not set where these were not asked
  /// for.
  std::optional<double> tied_angle;
  bool as_good = false;  ///< near a frame that the method calls equally good, or of planes that are as good on the
                         ///< whole as those of its own frame
  double milliseconds = 0.0;
};

/// To and from the bytes that processes pass on.
void put(detail::PackedBytes& bytes, const FrameErrors& errors);
void get(detail::UnpackedBytes& bytes, FrameErrors& errors);

/// Shares in [0, 1]; NaN where there is nothing to count.
struct AlignmentStatistics {
  AlignmentMethod method = AlignmentMethod::Symmetry;
  int num_models = 0, num_scans = 0;
  double closer_models = 0.0;  ///< models whose scans are in the mean closer than by center of mass
  double closer_scans = 0.0;
  double mean_center = 0.0, median_center = 0.0;  ///< of scans, diagonals
  double mean_ratio = 0.0, median_ratio = 0.0;    ///< of the errors by center of mass to these
  double own_scans = 0.0, own_wholes = 0.0;       ///< within 5 degrees, as all that follow
  double own_turned_scans = 0.0, own_turned_wholes = 0.0;
  double axes = 0.0, frames = 0.0, equal_axes = 0.0, as_good = 0.0;
  double median_ms = 0.0, p95_ms = 0.0;  ///< of scans

  /// The rates above as counts, for their intervals.
  Proportion counted_closer_models, counted_closer_scans, counted_own_scans, counted_own_wholes, counted_axes;
  Proportion counted_ties;       ///< FrameErrors::tied_angle
  Interval mean_ratio_interval;  ///< 95 %, models drawn anew
};

/// One for each method.
/// \param errors of the same clouds by all methods.
std::vector<AlignmentStatistics> summarize(const std::vector<FrameErrors>& errors);

void printTable(const std::vector<AlignmentStatistics>& statistics);

/// Counts with 95 % intervals, beside the figures that the paper gives.
void printIntervals(const std::vector<AlignmentStatistics>& statistics);
nlohmann::json toJson(const std::vector<AlignmentStatistics>& statistics);

/// A row for each cloud and method.
std::string frameCSV(const std::vector<FrameErrors>& errors);

/// Shares of the scans by misalignment (Figure 12).
struct Histogram {
  AlignmentMethod method;
  std::vector<double> lower_ends;  ///< of the bins; the last one is open
  std::vector<double> shares;
  int num_scans = 0;
};
std::vector<Histogram> translationHistograms(const std::vector<FrameErrors>& errors);  ///< per cent of the diagonal
std::vector<Histogram> rotationHistograms(const std::vector<FrameErrors>& errors);     ///< degrees

std::string histogramCSV(const std::vector<FrameErrors>& errors);

/// Figure 12 a and b with bands of 95 % intervals, of four methods, beside \p path: NAME_translation.png and
/// NAME_rotation.png.
void drawHistograms(const std::vector<FrameErrors>& errors, const std::string& path);

}  // namespace pcl_symmetry::apps
