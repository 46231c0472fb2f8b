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
  double score_errors = 1.5;     // or of this many deviations of a camera's depths
  int num_rotations = 12;        // about each principal axis that are tried at last

  // Evidence
  double min_tolerance = 0.02;  // within which surfaces are one, at least,
  double noises = 4.0;          // deviations of the scan from its own surface,
  double depth_errors = 2.0;    // or of the depths of a camera,
  double max_tolerance = 0.08;  // and at most
  double near = 0.24;           // a model, within which points are to be on it
  int picture_steps = 8;        // that pose a model in the picture
  double picture_reach = 3.0;   // tolerances, of the Gaussian at the first step

  // Confidence, see fit_recognition.py
  double few = 0.02;              // a share that is no evidence
  double most_shown = 0.85;       // of a model; more says no more, as scanners miss parts
  double max_lead = 0.4;          // over the best model of another shape that counts
  double same_shape = 0.9;        // share of the surfaces that models of one shape have in common,
  double same_surface = 0.03;     // with a Gaussian of this width: each was brought to the scan by itself,
  int num_compared_points = 500;  // by this many points
};
inline constexpr RecognitionRules kRecognition;

}  // namespace pcl_symmetry::detail
