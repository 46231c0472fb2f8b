#include "evaluate/rotations/meshes/scan_turns.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "common/shape_input/shape_input.h"
#include "core/base/constants.h"
#include "core/neighbours/distinct_points.h"
#include "evaluate/clouds/test_clouds.h"
#include "evaluate/rotations/meshes/true_shares.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shared/table_text.h"
#include "pcl_symmetry/core/rotation/rotational_symmetry.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

/// The turns that a scan is said to have.
std::vector<Eigen::Isometry3d> motionsOf(const SymmetryTurn& turn) {
  if (turn.fold == 0) return turnsByAnyAngle(turn.point, turn.direction);
  std::vector<Eigen::Isometry3d> motions;
  for (int k = 1; 2 * k <= turn.fold; ++k)
    motions.push_back(turnAbout(turn.point, turn.direction, 2.0 * kPi * k / turn.fold));
  return motions;
}

/// What else the scan says of its turns, as the library sees it.
std::vector<TurnSigns> signsOf(const std::vector<SymmetryTurn>& turns, const pcl::PointCloud<pcl::PointXYZ>& scan,
                               const DetectionOptions& options) {
  const Points points = DistinctPoints(finitePoints(scan)).points;
  const std::optional<Visibility> seen = detail::seenSpace(scan, points, Viewpoint());
  const GaussianEdt edt(points, options.edt);
  const NormalizedCloud cloud(points, edt, nullptr, &seen.value(), options.num_threads);
  return turnSigns(TurnEvidence(cloud, options.tolerance * cloud.extent, options.seed), turns);
}

std::vector<JudgedTurn> judged(const pcl::PolygonMesh& mesh, const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& scan,
                               const Eigen::Isometry3d& T_scan_model) {
  DetectionOptions options;
  options.min_possible = 0.0;
  options.num_threads = options.edt.num_threads = 1;
  const ShapeAnswers answers = detectShape(scan, options);
  if (answers.turns.empty()) return {};
  const double tolerance = ObjectSymmetryOptions().tolerance * diameterOf(mesh);
  const TrueShares shares(mesh, tolerance);
  const RotationLimits limits{tolerance, ObjectSymmetryOptions().max_feature};
  const Eigen::Isometry3d T_model_scan = T_scan_model.inverse();
  const std::vector<TurnSigns> signs = signsOf(answers.turns, *scan, options);
  std::vector<JudgedTurn> all;
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const SymmetryTurn& turn = answers.turns[i];
    SymmetryTurn of_model = turn;
    of_model.point = T_model_scan * turn.point;
    of_model.direction = T_model_scan.linear() * turn.direction;
    all.push_back({turn, signs[i], false, limits.excess(shares.worstOf(motionsOf(of_model)))});
  }
  return all;
}

}  // namespace

std::vector<JudgedTurn> judgedTurns(const Model& model, int num_views) {
  const Shape shape = loadShape(model.path);
  if (!shape.mesh) throw InputError(model.path + ": has no faces");
  TestCloudOptions options;
  options.random_views = true;
  const TestCloudMaker maker(*shape.mesh, model.key, options);
  std::vector<JudgedTurn> all;
  for (int view = 0; view < num_views; ++view) {
    CloudRecipe recipe;
    recipe.group = recipe.name = "scan " + std::to_string(view + 1);
    recipe.view = view;
    const TestCloud cloud = maker.make(recipe);
    const std::vector<JudgedTurn> some = judged(*shape.mesh, cloud.cloud, cloud.T_cloud_model);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::vector<JudgedTurn> judgedTurnsOfSolid(int i, bool report) {
  ShapeRowOptions options;
  options.report = report;
  options.threads = 1;
  const TurningScan solid = turningScan(i, options);
  std::vector<JudgedTurn> all = judged(solid.shape.mesh, solid.scan.cloud, solid.scan.T_scan_model);
  for (JudgedTurn& one : all) one.of_solid = true;
  return all;
}

namespace {

constexpr const char* kSolidName = "solid ";  // derived: meshes have names of files
// derived: the fields of JudgedTurn, as fieldsOf() has them.
constexpr const char* kTurnTitles = "scan,fold,confidence,support,off,far,halfway,grown,hold,planes_off,beside,excess";

/// The numbers of a turn in the order of the titles.
std::vector<double*> fieldsOf(JudgedTurn& one) {
  return {&one.turn.confidence, &one.turn.support, &one.turn.off,         &one.turn.far,     &one.turn.halfway,
          &one.signs.grown,     &one.signs.hold,   &one.signs.planes_off, &one.signs.beside, &one.excess};
}

}  // namespace

std::string turnTable(const std::vector<std::string>& names, const std::vector<std::vector<JudgedTurn>>& turns) {
  std::string text = std::string(kTurnTitles) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    for (JudgedTurn one : turns[i]) {
      Row row;
      row.add(names[i]).add(one.turn.fold);
      for (const double* value : fieldsOf(one)) row.add(*value);
      text += row.end();
    }
  return text;
}

std::vector<JudgedTurn> readTurnTable(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != kTurnTitles) throw InputError(path + ": line 1 must be " + kTurnTitles);
  std::vector<JudgedTurn> turns;
  for (int number = 2; std::getline(file, line); ++number) {
    std::istringstream row(line.substr(std::min(line.size(), line.find(',') + 1)));
    JudgedTurn one;
    one.of_solid = line.rfind(kSolidName, 0) == 0;
    char comma = ',';
    row >> one.turn.fold;
    for (double* value : fieldsOf(one)) row >> comma >> *value;
    if (!row) throw InputError(path + ": line " + std::to_string(number) + " must have the columns of line 1");
    turns.push_back(one);
  }
  return turns;
}

std::string solidName(int i) {
  return kSolidName + std::to_string(i);
}

std::string packed(const std::vector<JudgedTurn>& judged) {
  detail::PackedBytes bytes;
  for (JudgedTurn one : judged) {
    bytes.put(static_cast<std::int32_t>(one.turn.fold));
    for (const double* value : fieldsOf(one)) bytes.put(*value);
  }
  return bytes.bytes();
}

std::vector<JudgedTurn> unpackedTurns(const std::string& packed) {
  detail::UnpackedBytes bytes(packed);
  std::vector<JudgedTurn> judged;
  while (bytes.left() > 0) {
    JudgedTurn one;
    one.turn.fold = bytes.get<std::int32_t>();
    for (double* value : fieldsOf(one)) *value = bytes.get<double>();
    judged.push_back(one);
  }
  return judged;
}

}  // namespace pcl_symmetry::apps
