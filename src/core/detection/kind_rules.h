#pragma once

#include "core/evidence/plane_confidence.h"

namespace pcl_symmetry {

/// What differs between the kinds of cloud in detection (Section 4.4): one column of the table below a kind.
struct KindRules {
  // Candidates.
  bool completes_groups;  ///< the reflection of one symmetry in another is tried; a scan shows too few for that
  bool keeps_unlikely;    ///< candidates of little merit are refined beside symmetries, too: those of scans have little

  // Refinement.
  int full_share;        ///< the last stage reflects one sample in this many: a scan is limited by what was not seen
  int rough_share;       ///< candidates that never settle reflect one sample in this many
  double settled_merit;  ///< candidates with less never settle
  bool slides;           ///< point-to-plane steps slide a plane along the flat pieces that a scan has little beside
  bool climbs;  ///< planes climb to their maximum after the last stage; those of noisy scans have done so in it

  // Evidence.
  int judged_share;        ///< planes are judged by one sample in this many; 0 = by all points
  bool by_halves;          ///< one half of the points is compared with the other, as no surface is resolved
  bool may_lack_piece;     ///< open borders tell what was cut off
  double thin_tolerances;  ///< tolerances within which points are a sheet

  // Families of planes.
  bool normals_tell;      ///< normals point to axes and centers
  double family_share;    ///< of the surface seen, that the planes of a family map on average
  int family_samples;     ///< points that judge a family; a look-up in a density costs a tenth of a search
  bool family_needs_all;  ///< the worst plane of a family has to be a symmetry; a scan shows some too badly
  bool has_polygons;      ///< planes of a polygon are judged together, as noise hides single ones

  bool has_turns;      ///< axes of rotations are searched
  bool evens_density;  ///< the denser side is thinned
};

namespace kind_rules {

// clang-format off
//                                 Candidates    Refinement                      Evidence                 Families                          Other
constexpr KindRules kSurface{true,  false, 1, 10, 0.83, false, true,  0, false, true,  1.0, true,  0.92, 1500,   true,  false, false, false};
constexpr KindRules kScan{   false, true,  4, 20, 0.93, true,  false, 4, false, false, 1.0, true,  0.98, 1500,   false, false, true,  false};
constexpr KindRules kVolume{ true,  false, 1, 10, 0.83, false, true,  0, true,  false, 3.0, false, 0.92, 15'000, true,  true,  false, true};
// clang-format on

}  // namespace kind_rules

inline const KindRules& rulesOf(CloudKind kind) {
  switch (kind) {
    case CloudKind::Scan:
      return kind_rules::kScan;
    case CloudKind::Volume:
      return kind_rules::kVolume;
    default:
      return kind_rules::kSurface;
  }
}

}  // namespace pcl_symmetry
