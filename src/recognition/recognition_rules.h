#pragma once

#include <cstddef>

namespace pcl_symmetry::detail {

/// Numbers of recognition that decide which models are found. Lengths are radii of the object, shares those of points.
struct RecognitionRules {
  // Candidates
  int num_shape_forms = 2048;            // compact forms, at least, whose components are all compared
  std::size_t num_view_models = 200;     // models with the nearest codes, whose views are compared in full
  std::size_t max_pair_models = 300;     // larger databases have no pairs, which take 0.3 MB and 2 ms a model
  int num_pair_poses = 48;               // of each model that pairs vote for and that are tried
  std::size_t num_scan_points = 10'000;  // that poses are refined and judged by
  std::size_t num_fine_points = 5'000;   // of a model, that poses are refined and judged by

  // Poses
  double seen_radius = 0.95;     // radius of a scan over that of the whole object
  int num_judged_points = 3000;  // that decide whether a model fits,
  double min_width = 0.015;      // with a Gaussian of this width, or of the accuracy of the scan
  int num_rotations = 12;        // about each principal axis that are tried at last

  // Confidence
  double max_lead = 0.4;          // over the best model of another shape that counts, see fit_recognition.py
  double same_shape = 0.9;        // share of the surfaces that models of one shape have in common,
  double same_surface = 0.03;     // with a Gaussian of this width: each was brought to the scan by itself,
  int num_compared_points = 500;  // by this many points
};
inline constexpr RecognitionRules kRecognition;

}  // namespace pcl_symmetry::detail
