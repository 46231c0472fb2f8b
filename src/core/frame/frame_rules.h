#pragma once

#include <cstddef>

#include "core/base/constants.h"

namespace pcl_symmetry {

/// Parameters that affect the search for frames.
struct FrameRules {
  // Evidence
  double whole_sigma = 1.5;  // width of the Gaussian for whole clouds, cells: as narrow as the grid resolves
  // Width of the Gaussian for scans, cells: wider, because the other side of a plane was hardly seen.
  double scan_sigma = 2.25;
  double min_sigma = 1.5;         // least width of the Gaussian for sparse clouds, spacings of the points
  int num_profile_samples = 256;  // samples of the profiles that give the scores: an error of D of about 1 %
  // Weight of the scores of the second and third plane, and of agreement, in the value of a frame.
  double whole_weight = 0.6;
  // The same for scans: these terms break ties, as between planes along faces and along edges of a square box.
  double scan_weight = 0.3;
  double tail = 0.005;  // share of the points beyond either end of their extent: outliers
  double push = 0.05;   // radii by which the middle of a scanned object is farther from the scanner than its points
  double face_width = 6.0 * kDegree;      // width of the agreement of normals with an axis, radians
  double peak_width = 5.0 * kDegree;      // angle within which normals belong to one face, radians
  double peak_distance = 15.0 * kDegree;  // least angle between two faces, radians
  double min_peak = 0.03;                 // least share of the surface in a face
  int num_peak_starts = 150;              // normals that the search for faces starts from
  int num_peak_steps = 5;                 // steps of the search from each of them

  // Search
  double candidate_angle = 9.0 * kDegree;  // angle within which maxima of the map share one basin, radians
  std::size_t max_candidates = 24;         // greatest number of maxima of the map
  std::size_t num_angles = 30;             // angles of the second plane about the first axis, within 90 degrees
  // Greatest number of faces: three directions of a box, and three of a second part that is oblique to it.
  int max_faces = 6;
  std::size_t max_first_planes = 6;  // greatest number of first planes that are completed to frames
  int max_plane_moves = 4;           // greatest number of steps of one size for a first plane
  std::size_t max_refined = 6;       // greatest number of frames that are refined
  int max_frame_moves = 3;           // greatest number of steps of one size for a frame
  double half_way_weight = 0.15;     // weight of the half-way plane of scans
  double tie = 0.06;  // difference up to which scores are equal: D of a symmetry varies by 0.03 with the angle
  double same_frame = 5.0 * kDegree;  // angle within which frames are one, radians

  // Center, measured on models of PSB. The plane passes through the peak of the scores of a whole cloud if the peak is
  // clear.
  double offset_sharpness = 15.0;  // weight exp(15 s) of an offset of score s
  double offset_width = 0.07;  // radii; width of the weight about the middle of the extent, used if no peak is clear
  // Height of a clear peak above all scores beside it; less within offset_width of the weighted mean.
  double clear_height = 0.3;
  double clear_side = 0.25;        // radii; scores farther than this from the peak are beside it
  double clear_ramp = 0.1;         // additional height from which a clear peak counts fully
  float lost_height = 0.15f;       // height by which a profile may underestimate a peak between two cells
  int num_center_samples = 1024;   // samples that give the offset of the peak, to a tenth of a cell
  double center_sharpness = 30.0;  // weight exp(30 v) of the center of a frame whose value is v less than the best
  int num_revolution_angles = 8;   // angles at which a revolution is tested

  // Leveled frames, measured on models of PSB
  double touch = 0.01;                   // depth within which the outline touches a side, in longer sides of the box
  double outline_step = 1.0 * kDegree;   // step of the angle about the first axis, radians
  double max_lost_value = 0.1;           // greatest loss of value of a leveled frame that is put first
  double min_gained_contact = 0.1;       // least contact that a leveled frame must gain to be put first
  double same_outline = 10.0 * kDegree;  // angle within which first axes have one outline, radians
  std::size_t max_outlines = 2;          // greatest number of first axes whose outline is tried
  // Angle to the principal axes at which the term of the probability reaches its limit, radians.
  double far_from_principal = 20.0 * kDegree;
};
inline constexpr FrameRules kFrame;

}  // namespace pcl_symmetry
