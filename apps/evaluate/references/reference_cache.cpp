#include "evaluate/references/reference_cache.h"

#include <boost/filesystem.hpp>

#include "common/files/file_text.h"
#include "common/shape_output/shape_output.h"

namespace pcl_symmetry::apps {

namespace {

using nlohmann::json;

json toJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3d vectorFrom(const json& v) {
  return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
}

json toJson(const std::vector<ReferencePlane>& planes) {
  json list = json::array();
  for (const ReferencePlane& plane : planes) {
    const Eigen::Vector4d c = plane.plane.coefficients();
    list.push_back({{"coefficients", {c[0], c[1], c[2], c[3]}}, {"share", plane.share}});
  }
  return list;
}

std::vector<ReferencePlane> planesFrom(const json& list) {
  std::vector<ReferencePlane> planes;
  for (const json& plane : list) {
    const auto c = plane.at("coefficients").get<std::array<double, 4>>();
    planes.push_back({ReflectionPlane::fromCoefficients({c[0], c[1], c[2], c[3]}), plane.at("share").get<double>()});
  }
  return planes;
}

json toJson(const std::vector<ReferenceAxis>& axes) {
  json list = json::array();
  for (const ReferenceAxis& axis : axes)
    list.push_back({{"point", toJson(axis.point)}, {"direction", toJson(axis.direction)}, {"share", axis.share}});
  return list;
}

std::vector<ReferenceAxis> axesFrom(const json& list) {
  std::vector<ReferenceAxis> axes;
  for (const json& axis : list)
    axes.push_back({vectorFrom(axis.at("point")), vectorFrom(axis.at("direction")), axis.at("share").get<double>()});
  return axes;
}

json describe(const ReferenceOptions& options) {
  return {{"tolerance", options.tolerance},
          {"by_transform", options.by_transform},
          {"tolerance_in_diagonals", options.tolerance_in_diagonals},
          {"min_share", options.min_share},
          {"near_share", options.near_share},
          {"merge_angle", options.merge_angle},
          {"merge_offset", options.merge_offset},
          {"num_samples", options.num_samples},
          {"seed", options.seed}};
}

}  // namespace

json toJson(const ReferenceSymmetries& symmetries) {
  json centers = json::array();
  for (const ReferenceCenter& center : symmetries.centers)
    centers.push_back({{"point", toJson(center.point)}, {"share", center.share}});
  return {{"kind", toString(symmetries.kind)},
          {"best_share", symmetries.best_share},
          {"center", toJson(symmetries.center)},
          {"diagonal", symmetries.diagonal},
          {"diameter", symmetries.diameter},
          {"tolerance", symmetries.tolerance},
          {"planes", toJson(symmetries.planes)},
          {"axes", toJson(symmetries.axes)},
          {"centers", centers},
          {"near_planes", toJson(symmetries.near_planes)},
          {"near_axes", toJson(symmetries.near_axes)}};
}

ReferenceSymmetries referencesFromJson(const json& json) {
  ReferenceSymmetries symmetries;
  for (const SymmetryKind kind : {SymmetryKind::Symmetric, SymmetryKind::NearlySymmetric, SymmetryKind::Asymmetric})
    if (json.at("kind") == toString(kind)) symmetries.kind = kind;
  symmetries.best_share = json.at("best_share").get<double>();
  symmetries.center = vectorFrom(json.at("center"));
  symmetries.diagonal = json.at("diagonal").get<double>();
  symmetries.diameter = json.at("diameter").get<double>();
  symmetries.tolerance = json.at("tolerance").get<double>();
  symmetries.planes = planesFrom(json.at("planes"));
  symmetries.axes = axesFrom(json.at("axes"));
  for (const auto& center : json.at("centers"))
    symmetries.centers.push_back({vectorFrom(center.at("point")), center.at("share").get<double>()});
  symmetries.near_planes = planesFrom(json.at("near_planes"));
  symmetries.near_axes = axesFrom(json.at("near_axes"));
  return symmetries;
}

ReferenceCache::ReferenceCache(std::string path, const ReferenceOptions& options)
    : path_(std::move(path)), content_{{"options", describe(options)}, {"models", json::object()}} {
  if (path_.empty() || !boost::filesystem::exists(path_)) return;
  try {
    json read = json::parse(readWholeFile(path_));
    for (const auto& [name, value] : content_["options"].items()) {
      if (read.at("options").at(name) != value) {
        throw InputError(path_ + ": " + name + " = " + read["options"][name].dump() + ", must be " + value.dump() +
                         " as asked for now");
      }
    }
    for (const auto& [key, model] : read.at("models").items()) {
      referencesFromJson(model);
      model.at("num_faces").get<std::size_t>();
    }
    content_ = std::move(read);
  } catch (const json::exception& error) {
    throw InputError(path_ + ": is no file of references, " + error.what());
  }
}

std::optional<ReferenceSymmetries> ReferenceCache::find(const std::string& key, std::size_t num_faces) const {
  const auto entry = content_["models"].find(key);
  if (entry == content_["models"].end() || entry->at("num_faces") != num_faces) return std::nullopt;
  return referencesFromJson(*entry);
}

void ReferenceCache::add(const std::string& key, std::size_t num_faces, const ReferenceSymmetries& symmetries) {
  json model = apps::toJson(symmetries);
  model["num_faces"] = num_faces;
  content_["models"][key] = std::move(model);
  changed_ = true;
}

void ReferenceCache::save() {
  if (path_.empty() || !changed_) return;
  writeText(path_, content_.dump(1) + "\n");
  changed_ = false;
}

}  // namespace pcl_symmetry::apps
