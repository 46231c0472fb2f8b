/// The words of answers, in tables, JSON and pictures.
#pragma once

#include "pcl_symmetry/core/detect_planes.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

inline const char* toString(PlaneKind kind) {
  switch (kind) {
    case PlaneKind::Symmetry:
      return "symmetry";
    case PlaneKind::Possible:
      return "possible";
    case PlaneKind::Local:
      return "local";
    case PlaneKind::Approximate:
      break;
  }
  return "approximate";
}

/// Where the viewpoint of a scan is known from.
inline const char* toString(ViewpointSource source) {
  switch (source) {
    case ViewpointSource::Given:
      return "given";
    case ViewpointSource::Rays:
      return "rays";
    case ViewpointSource::Stored:
      return "stored";
    case ViewpointSource::Inferred:
      return "inferred";
    case ViewpointSource::None:
      break;
  }
  return "none";
}

}  // namespace pcl_symmetry::apps
