#pragma once

#include <cstddef>

namespace pcl_symmetry::detail {

/// Parameters that decide which models are found. Lengths are in radii of the object, and shares are shares of points,
/// unless stated otherwise.
struct RecognitionRules {
  // Candidates
  int num_shape_forms = 2048;         // least number of compact forms whose components are all compared
  std::size_t num_view_models = 200;  // models with the nearest codes, whose views are compared in full
  // Greatest number of models of a database with pairs, which take 0.3 MB and 2 ms per model.
  std::size_t max_pair_models = 300;
  int num_pair_poses = 48;               // poses of each model that pairs vote for and that are tried
  std::size_t num_scan_points = 10'000;  // points of a scan by which poses are refined and judged
  std::size_t num_fine_points = 5'000;   // points of a model by which poses are refined and judged

  // Poses
  double seen_radius = 0.95;     // radius of a scan, in radii of the whole object
  int num_judged_points = 3000;  // points that decide whether a model fits
  // Least width of the Gaussian for that, unless the accuracy of the scan or score_errors gives more.
  double min_width = 0.015;
  double score_errors = 1.5;  // width of the Gaussian for that, deviations of a camera's depths
  int num_rotations = 12;     // rotations about each principal axis that are tried last

  // Evidence
  double min_tolerance = 0.02;  // least distance within which surfaces agree
  double noises = 4.0;          // distance within which surfaces agree, deviations of the scan from its own surface
  double depth_errors = 2.0;    // distance within which surfaces agree, deviations of a camera's depths
  double max_tolerance = 0.08;  // greatest distance within which surfaces agree
  double near = 0.24;           // distance from a model within which points should lie on it
  int picture_steps = 8;        // steps that pose a model in the depth image
  double picture_reach = 3.0;   // width of the Gaussian at the first step, tolerances

  // Confidence, see fit_recognition.py
  double few = 0.02;         // share that is too small to be evidence
  double most_shown = 0.85;  // shown share of a model above which more makes no difference, because scanners miss parts
  double max_lead = 0.4;     // greatest lead over the best model of another shape that counts
  double same_shape = 0.9;   // least share of their surfaces that models of one shape have in common
  double same_surface = 0.03;     // width of the Gaussian for that: each model was registered to the scan by itself
  int num_compared_points = 500;  // points by which models are compared
};
inline constexpr RecognitionRules kRecognition;

}  // namespace pcl_symmetry::detail
