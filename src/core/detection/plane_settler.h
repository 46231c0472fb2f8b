#pragma once

#include <vector>

#include "core/detection/plane_judge.h"
#include "core/detection/staged_refinement.h"

namespace pcl_symmetry {

/// The last stage of refinement and the judgement, with as little work as the answer needs: planes that cannot be
/// symmetries beside the ones that were found are left out after a look at some points, and planes climb only where
/// that may decide.
class PlaneSettler {
public:
  /// \param refinement,judge must outlive this object.
  /// \param looks the cloud is a whole surface, and planes that are no symmetries are not asked for where there are any.
  PlaneSettler(const StagedRefinement& refinement, const PlaneJudge& judge, bool looks)
      : refinement_(refinement), judge_(judge), looks_(looks) {}

  /// \param candidates after the second stage, best first.
  /// \return the planes that may be symmetries, and where there are none, the others too; input frame.
  std::vector<SymmetryPlane> planes(std::vector<Candidate> candidates);

private:
  std::vector<SymmetryPlane> judged(std::vector<Candidate> candidates) const;
  void note(const std::vector<SymmetryPlane>& planes);

  const StagedRefinement& refinement_;
  const PlaneJudge& judge_;
  bool looks_;
  bool explained_ = false;  ///< a plane explains all of the cloud, so that nothing is missing
};

}  // namespace pcl_symmetry
