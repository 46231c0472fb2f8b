#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/detection/plane_families.h"
#include "core/distance_transform/free_space.h"
#include "core/evidence/plane_support.h"
#include "core/evidence/point_density.h"
#include "core/neighbours/surface_normals.h"
#include "pcl_symmetry/core/detection/plane_detection.h"

namespace pcl_symmetry {

/// A plane on its way through the stages of refinement, in the normalised frame: the points in the unit ball about 0.
struct Candidate {
  ReflectionPlane plane;
  bool from_map;  ///< has a cell to stay in
  int iterations = 0;
  IspResult last = {};
  double merit = 0.0;  ///< seenSymmetry() of support and conflict among the samples of the last stage; may exceed 1
};

/// From the maxima of a map to precise planes with all that is known of them (Section 4.4), stage by stage.
class Refinement {
public:
  /// \param search,visibility as in refineMaxima().
  Refinement(const PointsRef& points, const GaussianEdt& edt, const DetectionOptions& options,
             ClosestPointSearch::Ptr search, const Visibility* visibility);

  /// Maxima of the map and planes across the principal axes.
  std::vector<Candidate> gather(const SymmetryMap& map) const;

  /// Few samples and wide weights: most candidates end in a basin that another one found, or leave their cell.
  void refineCoarsely(const SymmetryMap& map, std::vector<Candidate>& candidates) const;

  /// Weights as narrow as the spacing of the points allows, still on a part of them.
  void refineClosely(std::vector<Candidate>& candidates, double least_merit = -1.0) const;

  /// All samples; the precision of the planes is decided here.
  std::vector<SymmetryPlane> finish(std::vector<Candidate>& candidates) const;

  /// The reflection of one symmetry in another is a symmetry: those that the map did not show, refined closely.
  /// \param known planes that have been tried; those tried now are added.
  std::vector<Candidate> closure(const std::vector<SymmetryPlane>& planes, std::vector<ReflectionPlane>& known) const;

  /// Moves planes that belong to a family from the planes to axes and centers.
  void collectFamilies(Detection& detection) const;

  /// Symmetries of parts of the surface, other than those known.
  std::vector<SymmetryPlane> findParts(const std::vector<SymmetryPlane>& known) const;

  /// Best first, each once, as the options ask.
  std::vector<SymmetryPlane> report(std::vector<SymmetryPlane> planes) const;

private:
  /// Of a set of samples.
  struct Shares {
    double support, conflict;
    std::vector<float> point_support;
  };

  bool same(const ReflectionPlane& a, const ReflectionPlane& b) const;
  bool onSlopeOf(const SymmetryPlane& better, const SymmetryPlane& plane) const;
  bool isSymmetry(const SymmetryPlane& plane) const { return plane.kind == PlaneKind::Symmetry; }
  double leastMerit(double slack) const;

  void run(std::vector<Candidate>& candidates, int num_samples, double sigma, double final_sigma,
           int max_iterations) const;
  void returnIfSlid(Candidate& candidate, const ReflectionPlane& start, const std::vector<int>& samples,
                    double sigma) const;
  void runByDensity(std::vector<Candidate>& candidates, int num_samples) const;
  Shares sharesOf(const ReflectionPlane& plane, const std::vector<int>& samples, const IspStep& step) const;
  Shares sharesOf(const ReflectionPlane& plane, const std::vector<int>& samples) const;
  double meritOf(const Shares& shares) const;
  std::vector<Candidate> distinct(std::vector<Candidate> candidates, double least_merit, std::size_t most) const;
  void judge(SymmetryPlane& plane, const Shares& shares) const;
  FamilyTest familyTest(const std::vector<int>& samples) const;
  double familyShare(const ReflectionPlane& plane, const std::vector<int>& samples) const;
  SymmetryAxis judgedFamily(const std::vector<ReflectionPlane>& planes, const std::vector<int>& samples) const;

  const GaussianEdt& edt_;
  const DetectionOptions& options_;
  Eigen::Vector3d center_;
  double scale_;
  Points points_;
  ClosestPointSearch::Ptr search_;
  LocalGeometry geometry_;
  FarTest far_;
  IspSurface surface_;
  std::optional<Visibility> visibility_;
  double sigma_;
  double spacing_;
  double roughness_;
  double final_sigma_;
  double baseline_;
  std::optional<PointDensity> density_;  ///< where the points resolve no surface

  ReflectionPlane toNormalized(const ReflectionPlane& p) const {
    return ReflectionPlane(p.normal(), p.signedDistance(center_) / -scale_);
  }
  ReflectionPlane toInput(const ReflectionPlane& p) const {
    return ReflectionPlane(p.normal(), p.offset() * scale_ + p.normal().dot(center_));
  }
};

}  // namespace pcl_symmetry
