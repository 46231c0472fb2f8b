#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcl_symmetry/core/exports.h"
#include "pcl_symmetry/core/gaussian_edt.h"
#include "pcl_symmetry/core/planar_transform.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// The discrete space of axes, the counterpart of PlaneGrid: the direction of an axis, theta in [0, pi/2] and phi in
/// [0, 2 pi), and the point (u, v) where it meets the perpendicular plane through a center, both in [-radius, radius].
/// u increases in the direction of increasing theta, v in that of increasing phi. Not in the paper.
class AxisGrid {
public:
  /// Indices of a cell of the grid.
  struct Bin {
    int theta;  ///< in [0, numTheta())
    int phi;    ///< in [0, numPhi())
    int u;      ///< in [0, numOffset())
    int v;      ///< in [0, numOffset())
  };

  AxisGrid() = default;

  /// \param num_theta,num_phi,num_offset numbers of bins, each in [1, 1024]; num_phi even.
  /// \param center finite, input frame; u and v are measured from it.
  /// \param radius finite and > 0, input units.
  /// \throws std::invalid_argument naming field, value and rule, also for more than 2^28 bins.
  AxisGrid(int num_theta, int num_phi, int num_offset, const Eigen::Vector3d& center, double radius);

  int numTheta() const { return num_theta_; }    ///< bins of theta
  int numPhi() const { return num_phi_; }        ///< bins of phi
  int numOffset() const { return num_offset_; }  ///< bins of u, and of v
  /// Bins of theta times bins of phi.
  std::size_t numDirections() const { return static_cast<std::size_t>(num_theta_) * num_phi_; }
  std::size_t size() const { return numDirections() * num_offset_ * num_offset_; }  ///< number of all bins
  const Eigen::Vector3d& center() const { return center_; }                         ///< origin of u and v, input frame
  double radius() const { return radius_; }  ///< greatest |u| and |v|, input units
  /// Distance between neighboring bins of u or v, input units.
  double offsetStep() const { return 2.0 * radius_ / num_offset_; }

  /// \return ((theta * num_phi + phi) * num_offset + v) * num_offset + u: bins of one direction lie side by side.
  std::size_t index(const Bin& bin) const;
  /// \return the bin of an index; the inverse of index().
  Bin bin(std::size_t index) const;

  /// \return u or v at the bin center, input units.
  double offset(int k) const { return (k + 0.5) * offsetStep() - radius_; }
  /// The frame whose third column is a direction of the grid.
  /// \param direction theta * num_phi + phi, in [0, numDirections()).
  /// \return columns: the directions of u, of v and of the axes; right-handed.
  Eigen::Matrix3d frame(std::size_t direction) const;

  /// \return the axis at the bin center; its origin lies in the perpendicular plane through center().
  Line3d axis(const Bin& bin) const;

private:
  int num_theta_ = 0, num_phi_ = 0, num_offset_ = 0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
};

/// Options of axialTransform().
struct AxialTransformOptions {
  /// Orders of the rotations, each 0 or in [2, 60], without repetition; 0 = rotations by any angle.
  std::vector<int> folds{0, 2, 3, 4, 5, 6, 7, 8};
  int num_samples = 192;   ///< points drawn for the whole map, in [1, 10^6]; the error falls about as num_samples^-0.7
  std::uint64_t seed = 1;  ///< seed of the points drawn
  int num_threads = 0;     ///< >= 0; 0 = one per core; the map does not depend on it

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// The axial symmetry transform of a shape. For rotations of order n about an axis
///
///   D_n(f, axis) = mean over k = 1 ... n - 1 of f . R_k(f) / |f|^2,   R_k: the rotation by 2 pi k / n,
///
/// D_n is 1 for a perfect symmetry, like D of Equation 2 for a reflection: the part of f that is invariant under these
/// rotations has the squared length (1 + (n - 1) D_n) / n in units of |f|^2, which is Equation 1 for n = 2. For
/// rotations by any angle, D is the mean over all angles.
struct AxisMap {
  AxisGrid grid;                           ///< the axes of the values
  std::vector<int> folds;                  ///< as in AxialTransformOptions
  std::vector<std::vector<float>> values;  ///< for each fold, grid.size() values of D_n; 0 where u^2 + v^2 > radius^2
  std::vector<float> greatest;             ///< the greatest D_n of each bin
  double sigma = 0.0;                      ///< width of the GEDT that the map was made from, input units

  /// \return index of the bin with the greatest value; 0 for an empty map.
  std::size_t strongest() const { return std::max_element(greatest.begin(), greatest.end()) - greatest.begin(); }
  bool empty() const { return greatest.empty(); }  ///< no transform was computed
};

/// The order of the rotations about an axis: 0 (any angle) if their D is the greatest, else the highest fold whose D
/// is. Values of D within 0.005 of the greatest count as equal: a shape of six equal parts also has folds three and
/// two.
/// \param folds as in AxisMap.
/// \param values D_n of each fold.
int bestFold(const std::vector<int>& folds, const std::vector<double>& values);

/// The axial symmetry transform by sampling, as sampledTransform() does for planes: D_n = (S / |f|^2) times the mean of
/// f(R_k x_i), with points x_i drawn with probability f / S once for the whole map.
/// \param edt the function f.
/// \param grid the axes, in the frame of the EDT.
/// \param visibility what the scanner saw, in the same frame; null for a whole object. Values are then (1 + c) D / (D +
/// F + c) as in sampledTransform().
/// \throws std::invalid_argument for bad options.
AxisMap axialTransform(const GaussianEdt& edt, const AxisGrid& grid, const AxialTransformOptions& options = {},
                       const Visibility* visibility = nullptr);

/// A local maximum of the axial transform, between bins.
struct AxisMaximum {
  Line3d axis;                 ///< input frame
  int fold = 0;                ///< order of the rotations, see bestFold()
  double value = 0.0;          ///< the greatest D_n
  std::vector<double> values;  ///< D_n of each fold of the map
};

/// The strongest local maxima: each moves from its bin to where D of its best fold is greatest.
/// \param map computed from the same EDT, of a whole object.
/// \param count greatest number of maxima, >= 1.
/// \param min_value least D, in [0, 1].
/// \return strongest first, no two within 15 degrees and three sigmas of each other.
std::vector<AxisMaximum> axisMaxima(const AxisMap& map, const GaussianEdt& edt, int count, double min_value = 0.5,
                                    const AxialTransformOptions& options = {});

/// The transform mapped back from axes to points, as pointSymmetry() does for planes: for each point the greatest value
/// of any axis through it, bilinear between the bins of u and v.
/// \param points 3 x N, finite, input frame.
/// \param num_threads 0 = one per core; the values do not depend on it.
/// \return one value per point, >= 0; 0 where no axis of the map passes.
std::vector<float> axialPointSymmetry(const AxisMap& map, const PointsRef& points, int num_threads = 0);

/// Symmetry with respect to points: D(f, c) = f . f(2 c - x) / |f|^2 for centers c on a cubic lattice.
struct CenterMap {
  int num_centers = 0;                               ///< number of centers along each edge
  double step = 0.0;                                 ///< distance between neighboring centers, input units
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< position of center (0, 0, 0), input frame
  std::vector<float> values;                         ///< num_centers^3 values of D, x fastest

  Eigen::Vector3d center(std::size_t index) const;  ///< position of a center, input frame
  /// \return index of the greatest value; 0 for an empty map.
  std::size_t strongest() const { return std::max_element(values.begin(), values.end()) - values.begin(); }
  /// \return the value at \p x, trilinear between the centers; 0 outside the lattice.
  double operator()(const Eigen::Vector3d& x) const;
};

/// The point symmetry of f by sampling, on the bounding cube of the EDT's ball.
/// \param num_centers number of centers along each edge, in [2, 512].
/// \param options folds are not used.
/// \param visibility as in axialTransform().
/// \throws std::invalid_argument for bad options.
CenterMap centralTransform(const GaussianEdt& edt, int num_centers = 64, const AxialTransformOptions& options = {},
                           const Visibility* visibility = nullptr);

}  // namespace pcl_symmetry
