#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pcl_symmetry/core/distance_transform/gaussian_edt.h"
#include "pcl_symmetry/core/geometry/point_set.h"
#include "pcl_symmetry/core/geometry/reflection_plane.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/exports.h"

namespace PCL_SYMMETRY_EXPORTS pcl_symmetry {

/// How Iterative Symmetric Points moves the plane.
enum class IspUpdate {
  PointToPoint,  ///< the paper's: the plane that minimises the weighted squared distances of the pairs, in closed form
  PointToPlane   ///< distances across the surface only: a Gauss-Newton step, converges in far fewer iterations
};

struct IspOptions {
  IspUpdate update = IspUpdate::PointToPlane;
  double sigma = 0.0;        ///< width of the Gaussian weights exp(-dist^2 / sigma^2) at the start, input units, > 0
  double final_sigma = 0.0;  ///< width at the end, input units, in (0, sigma]; halved whenever the plane rests
  int max_iterations = 30;   ///< >= 1
  /// Converged when the plane moves by less than this, in radians and in input units divided by the extent of the
  /// samples (the root mean square distance from their mean), >= 0 ...
  double tolerance = 1e-7;
  /// ... or by less than this share of its own standard error, residual / sqrt(number of samples), >= 0: beyond that,
  /// matches that change sides keep a plane of sampled points in motion without making it better.
  double error_share = 0.5;

  /// \throws std::invalid_argument naming field, value and rule.
  void validate() const;
};

/// Tells from a distance transform, without a search, that a point is far from the surface.
class FarTest {
public:
  /// \param edt of the surface, must outlive this object. \param center,scale of the frame of the questions: points are
  /// (x - center) / scale.
  FarTest(const GaussianEdt& edt, const Eigen::Vector3d& center, double scale)
      : edt_(edt), center_(center), scale_(scale) {}

  /// The least f that a cell has that holds a point within \p distance of the surface.
  float bound(double distance) const {
    const double half_diagonal = 0.5 * std::sqrt(3.0) * edt_.cellSize();
    const double reach = (distance * scale_ + half_diagonal) / edt_.sigma();
    return static_cast<float>(std::exp(-reach * reach));
  }

  /// Whether \p x is farther away than the distance of \p bound (or outside the grid).
  bool operator()(const Eigen::Vector3d& x, float bound) const {
    const Eigen::Array3d cell = ((x * scale_ + center_ - edt_.origin()) / edt_.cellSize()).array() + 0.5;
    const int n = edt_.numCells();
    if (!(cell >= 0.0).all() || !(cell < static_cast<double>(n)).all()) return true;
    const auto index = (static_cast<std::size_t>(cell.z()) * n + static_cast<std::size_t>(cell.y())) * n +
                       static_cast<std::size_t>(cell.x());
    return edt_.values()[index] <= std::min(bound, kFarthest);
  }

private:
  static constexpr float kFarthest = 1e-3f;  // the transform is cut off there
  const GaussianEdt& edt_;
  Eigen::Vector3d center_;
  double scale_;
};

/// The surface that reflected samples are matched to.
struct IspSurface {
  const Points& points;
  const Points& normals;  ///< 3 x N unit normals of any sign; may be empty with PointToPoint
  const ClosestPointSearch& search;
  /// Matches to these points get no weight: at the rim of a scan the true match may just not have been seen. Null:
  /// none.
  const std::vector<char>* at_border = nullptr;
  const FarTest* far = nullptr;  ///< spares the search for points that would get no weight
  int num_threads = 1;           ///< for the searches of one iteration; 0 = one per core
};

/// What one iteration saw and did: everything that a picture of it needs (Figure 7).
struct IspStep {
  ReflectionPlane plane;            ///< the plane after the step
  double residual = 0.0;            ///< weighted root mean square distance of the pairs before the step, input units
  double weight = 0.0;              ///< mean weight of the pairs, in [0, 1]
  std::vector<int> closest;         ///< for each sample the closest point to its reflection; -1: none within 3 sigma
  std::vector<float> sq_distances;  ///< and its squared distance; infinite where there is none
};

struct IspResult {
  ReflectionPlane plane;
  int iterations = 0;
  bool converged = false;
  IspStep last;  ///< of the last iteration: its distances are those before a step that no longer mattered
};

/// Pairs (x, y) of a sample and the closest point to its reflection, with weights: the sums of the closed form.
///
/// sum w |x' - y|^2 = const + 4 sum w (n.x - r)(n.y - r), hence r = n.m with m the weighted mean of (x + y) / 2, and n
/// is the eigenvector of the smallest eigenvalue of sum w [(x - m)(y - m)^T + (y - m)(x - m)^T] / 2. \param x,y 3 x M.
/// \param weights M values >= 0. \return \p fallback where the weights vanish.
ReflectionPlane fitReflectionPlane(const PointsRef& x, const PointsRef& y, const std::vector<double>& weights,
                                   const ReflectionPlane& fallback);

/// The plane after one Gauss-Newton step on sum w (m . (x' - y))^2, m the mean direction of the normals at y and of the
/// reflected normal at x. Directions that this leaves free (a flat piece of surface says nothing about planes across
/// it) move by a step on sum w |x' - y|^2. \param x,y,x_normals,y_normals 3 x M. \param weights M values >= 0.
ReflectionPlane stepReflectionPlane(const PointsRef& x, const PointsRef& y, const PointsRef& x_normals,
                                    const PointsRef& y_normals, const std::vector<double>& weights,
                                    const ReflectionPlane& plane);

/// One iteration of Iterative Symmetric Points (Section 4.4): reflect, match, weight, move the plane.
/// \param samples indices of the points of the surface to reflect. \param guesses what IspStep::closest was for a plane
/// nearby, which makes the search faster; null: not known.
IspStep iterateSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples, const ReflectionPlane& plane,
                               double sigma, IspUpdate update, const std::vector<int>* guesses = nullptr);

/// Iterates until the plane stands still.
IspResult refineSymmetricPoints(const IspSurface& surface, const std::vector<int>& samples,
                                const ReflectionPlane& plane, const IspOptions& options);

}  // namespace pcl_symmetry
