#pragma once

#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

/// What differs between the kinds of cloud in detection (Section 4.4). The values here are those of a surface.
struct KindRules {
  // Candidates.
  bool completes_groups = true;  ///< the reflection of one symmetry in another is tried; a scan shows too few for that
  bool keeps_unlikely = false;  ///< candidates of little merit are refined beside symmetries, too: a scan's have little

  // Refinement.
  int full_share = 1;           ///< the last stage reflects one sample in this many: a scan is limited by what it shows
  int rough_share = 10;         ///< candidates that never settle reflect one sample in this many
  double settled_merit = 0.83;  ///< candidates with less never settle
  bool slides = false;          ///< point-to-plane steps slide a plane along flat pieces that a scan has little beside
  bool climbs = true;  ///< planes climb to their maximum after the last stage; those of noisy scans have done so in it

  // Evidence.
  int judged_share = 0;          ///< planes are judged by one sample in this many; 0 = by all points
  bool by_halves = false;        ///< one half of the points is compared with the other, as no surface is resolved
  bool may_lack_piece = true;    ///< open borders tell what was cut off
  double thin_tolerances = 1.0;  ///< tolerances within which points are a sheet

  // Families of planes.
  bool normals_tell = true;    ///< normals point to axes and centers
  double family_share = 0.92;  ///< of the surface seen, that the planes of a family map on average
  /// Share of the surface by which planes of a family may differ, at that many points or more.
  double family_allowance = 0.015, points_of_allowance = 0.0;
  int family_samples = 1500;     ///< points that judge a family; a look-up in a density costs a tenth of a search
  bool family_needs_all = true;  ///< the worst plane of a family has to be a symmetry; a scan shows some too badly
  bool has_polygons = false;     ///< planes of a polygon are judged together, as noise hides single ones

  bool has_turns = false;      ///< axes of rotations are searched
  bool evens_density = false;  ///< the denser side is thinned
};

constexpr KindRules scanRules() {
  KindRules rules;
  rules.completes_groups = false;
  rules.keeps_unlikely = true;
  rules.full_share = 4;
  rules.rough_share = 20;
  rules.settled_merit = 0.93;
  rules.slides = true;
  rules.climbs = false;
  rules.judged_share = 4;
  rules.may_lack_piece = false;
  rules.family_share = 0.98;
  rules.family_needs_all = false;
  rules.has_turns = true;
  return rules;
}

constexpr KindRules volumeRules() {
  KindRules rules;
  rules.by_halves = true;
  rules.may_lack_piece = false;
  rules.thin_tolerances = 3.0;
  rules.normals_tell = false;
  rules.family_allowance = 0.012;
  rules.points_of_allowance = 10'000.0;
  rules.family_samples = 15'000;
  rules.has_polygons = true;
  rules.evens_density = true;
  return rules;
}

inline const KindRules& rulesOf(CloudKind kind) {
  static constexpr KindRules surface, scan = scanRules(), volume = volumeRules();
  return kind == CloudKind::Scan ? scan : kind == CloudKind::Volume ? volume : surface;
}

}  // namespace pcl_symmetry
