#pragma once

#include "pcl_symmetry/symmetry_scene.h"

namespace pcl_symmetry::detail {

/// Whether a cluster is a flat piece of a table, floor or wall that noise lifts off its plane: stereo cameras measure
/// walls in waves, and depths far away have large errors. All of its points lie near one plane, along its outline the
/// surface goes on, and nowhere does it end before something farther. An object, also a thin one, does.
/// \param frame organized; others have no such clusters.
/// \param cluster indices of finite points, at least one.
/// \param seen of this frame; null: no such clusters.
/// \param tolerance how far a symmetric surface may be off, as a share of the diagonal, > 0.
/// \param distance of points of one object, input units, > 0.
bool isBulge(const SymmetryScene::Cloud& frame, const pcl::Indices& cluster, const Visibility* seen, double tolerance,
             double distance);

}  // namespace pcl_symmetry::detail
