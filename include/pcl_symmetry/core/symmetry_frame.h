#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/visibility.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// Options of symmetryFrame(), and the bins of the map that candidates for the first plane come from.
struct FrameOptions : MapSize {
  int num_cells = 64;  ///< cells of the distance transform along each side, in [8, 512]
  /// Width of the Gaussian of the distance transform, input units, >= 0. 0 = 1.5 cells (2.25 for a scan) or 1.5
  /// spacings, whichever is more; with as_published, two cells or one spacing.
  double sigma = 0.0;
  int num_samples = 64;  ///< samples of the transform that gives the map, >= 1
  /// Uses the paper's own method: the plane of greatest D among the maxima of the exact map of 64 x 64 x 64 bins,
  /// refined by publishedPlanes(); then two more picked greedily by D, from 256 samples (an error of 1 %), at 64 angles
  /// about the first axis. It ignores what a scanner saw, and no scores tie.
  bool as_published = false;
  /// Searches the axes of rotation of scans, too, see SymmetryFrame::rotations; the frame is moved onto those that are
  /// not half turns. False saves about a third of the time.
  bool rotations = true;
  /// Moves the center and axes to the planes of symmetry that detectPlanes() decides, and to the axes of rotations.
  bool refined = true;
  bool probabilities = true;  ///< whether SymmetryFrame::probable is filled; takes about a seventh of the time
  std::uint64_t seed = 1;     ///< seed of all random draws
  int num_threads = 0;        ///< >= 0; 0 = one per core

  /// \return num_cells, sigma and num_threads as options of the distance transform.
  GaussianEdtOptions edtOptions() const { return {num_cells, sigma, num_threads}; }

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

class MeshSurface;

/// A frame that may be the shape's own: the one in which people would place it.
struct ProbableFrame {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();    ///< center of symmetry, input frame
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< axes in columns, as in SymmetryFrame
  int revolution_axis = -1;                            ///< column of the axis of revolution, as in SymmetryFrame
  /// Probability that the axes, in any order and with any signs, are within 5 degrees of the shape's own axes, in [0,
  /// 1]; a frame with an axis of revolution may be rotated about it. Fitted to models whose files define their own axes
  /// (test/benchmark/fit_frames.py).
  double probability = 0.0;
  /// Terms of the probability, in this order: 1; the value minus that of the best frame; the score of the first plane;
  /// the contact of the outline with its box; the angle to the principal axes over 20 degrees, at most 1; 1 for the
  /// frame that the search put first; the sum of the scores of the other planes; the score of the first plane if the
  /// search put the frame first, else 0.
  std::array<double, 8> evidence{};
};

/// The canonical frame of a shape: center of symmetry (COS) and principal symmetry axes (PSA, Section 5.1).
struct SymmetryFrame {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< center of symmetry, where the three planes meet, input frame
  /// Principal symmetry axes in columns, orthonormal, right-handed: the normal of the best plane, the normal of the
  /// best plane perpendicular to it, and their cross product.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Score of the plane perpendicular to each axis, in [0, 1]. For a whole cloud it is D. For a scan it is
  /// seenSymmetry() of D and free space; for the second and third plane it is measured on the scan completed by its
  /// reflection in the first.
  Eigen::Vector3d scores = Eigen::Vector3d::Zero();
  /// Column that is an axis of revolution; -1 = none, 3 = every line through the center is one.
  int revolution_axis = -1;
  /// Maps the center to 0 and the axes to x, y, z.
  Eigen::Isometry3d T_canonical_input = Eigen::Isometry3d::Identity();
  /// T_canonical_input of all frames that symmetry makes equally good, this one first. A plane has no sign, so every
  /// choice of signs that is a rotation is listed. Where scores tie, other orders and other axes are listed too: first
  /// those that are maxima, then the angles between them in steps of 6 degrees. Rotations about an axis of revolution
  /// are equally good as well and are not listed.
  std::vector<Eigen::Isometry3d> equivalent;
  std::size_t num_maxima = 0;  ///< frames at the front of equivalent that are maxima
  /// Frames that may be the shape's own, each once up to order, signs and rotations about an axis of revolution: this
  /// frame first, the others by decreasing probability. They are maxima of symmetry, and frames leveled by the outline
  /// or by faces of the surface. Their probabilities add up to less than 1; the remainder is the probability of any
  /// other frame. Empty without FrameOptions::probabilities.
  std::vector<ProbableFrame> probable;
  /// Axes of rotation of a scan, through the center or not, most confident first. They tell which poses look the same
  /// where the planes alone do not, as for a propeller.
  std::vector<SymmetryRotation> rotations;
  int num_stray_points = 0;                               ///< points far from all others, which were left out
  std::vector<std::pair<std::string, double>> timing_ms;  ///< stages in order, with their milliseconds
};

/// Finds the canonical frame: the plane of greatest symmetry, the greatest among those perpendicular to it, and the
/// plane perpendicular to both (Section 5.1). The center of symmetry is where the three meet.
///
/// Departure from the paper: of two nearly equal planes, the one aligned with faces of the surface is taken. If no
/// offset stands out, a plane passes near the middle of the extent. If faces around the first axis make the shape stand
/// level at little loss of symmetry, the other two axes follow them. A scan is completed by its reflection in the first
/// plane before the other two are searched, and free space counts against planes. The center is a mean over frames that
/// are nearly as good.
///
/// Order: the first plane makes the best frame as a whole. The second scores more than the third or, if
/// the two tie, the points spread more along its normal. Signs: the third central moment of the points along the second
/// and third axis is positive; the sign of the first axis makes the frame right-handed. Along the normal of a symmetry
/// plane this moment vanishes, and the sign is a matter of chance. SymmetryFrame::equivalent lists all signs.
/// \param points 3 x N, finite, input units; at least two different ones.
/// \param options numbers of bins and samples, threads.
/// \param visibility what a scanner saw, input frame; null = the points show the object from all sides.
/// \param make_search makes the closest-point search for the axes of rotation of a scan; null = FLANN.
/// \return the frame, in the input frame.
/// \throws std::invalid_argument for bad options or points without extent.
SymmetryFrame symmetryFrame(const PointsRef& points, const FrameOptions& options = {},
                            const Visibility* visibility = nullptr, const MakeSearch& make_search = nullptr);

/// Moves the center and axes of a frame to the planes of symmetry of the mesh that its points were spread over. Axes
/// whose perpendicular plane is no symmetry at 1 % of the diameter follow the others.
void refineOnMesh(const MeshSurface& mesh, SymmetryFrame& frame);

/// Makes a plane that was found by other means the first plane of a frame: the axis nearest to its normal becomes the
/// first and is rotated onto it, the center moves onto the plane, and the rest of the frame moves with them. In the
/// canonical frame, the plane is then x = 0.
void bringToPlane(const ReflectionPlane& plane, SymmetryFrame& frame);

/// Moves a frame to the center, or else to the best axis of revolution, that detectPlanes() found; the axis of the
/// frame nearest to it is rotated onto it. The frame stays unchanged if there is neither.
void bringToSymmetry(const Detection& found, SymmetryFrame& frame);

}  // namespace pcl_symmetry
