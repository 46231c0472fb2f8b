#include "evaluate/planes/plane_answers.h"

#include <array>
#include <boost/filesystem.hpp>
#include <nlohmann/json.hpp>

#include "common/command_line/console.h"
#include "common/files/file_text.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace pcl_symmetry::apps {

namespace {

using nlohmann::json;

Eigen::Vector3d vectorFrom(const json& v) {
  const auto values = v.get<std::array<double, 3>>();
  return {values[0], values[1], values[2]};
}

ReflectionPlane planeFrom(const std::array<double, 4>& c) {
  return ReflectionPlane::fromCoefficients({c[0], c[1], c[2], c[3]});
}

/// An order as scores: 1, 1/2, 1/3 ...
double scoreOfRank(std::size_t index) {
  return 1.0 / static_cast<double>(index + 1);
}

PlaneAnswers answersFromJson(const std::string& path) {
  const json content = json::parse(readWholeFile(path));
  const auto listOf = [&](const char* name) { return content.value(name, json::array()); };
  PlaneAnswers result;
  std::vector<Answer>& answers = result.answers;
  const auto score = [&](const json& entry) {
    return entry.value("confidence", entry.value("score", scoreOfRank(answers.size())));
  };
  const auto markRank = [&](const json& entry) {
    answers.back().rank_only = !entry.contains("confidence") && !entry.contains("score");
  };
  for (const json& center : listOf("centers")) {
    answers.push_back(Answer::ofCenter(vectorFrom(center.at("point")), score(center)));
    markRank(center);
  }
  for (const json& axis : listOf("axes")) {
    answers.push_back(Answer::ofAxis(vectorFrom(axis.at("point")), vectorFrom(axis.at("direction")), score(axis)));
    markRank(axis);
  }
  for (const json& plane : content.at("planes")) {
    answers.push_back(Answer::ofPlane(planeFrom(plane.at("coefficients").get<std::array<double, 4>>()), score(plane)));
    markRank(plane);
    answers.back().called = plane.value("kind", "symmetry") == "symmetry";
  }
  const json timing = content.value("timing_ms", json::object());
  if (timing.contains("total")) result.milliseconds = timing["total"].get<double>();
  return result;
}

PlaneAnswers answersFromText(const std::string& path) {
  const std::string text = boost::filesystem::file_size(path) > 0 ? readWholeFile(path) : "";  // empty = no plane
  TokenReader reader(text, path);
  PlaneAnswers result;
  std::vector<Answer>& answers = result.answers;
  while (!reader.atEnd()) {
    std::array<double, 4> coefficients;
    for (double& c : coefficients) c = reader.number("coefficient of plane", answers.size() + 1);
    double score = scoreOfRank(answers.size());
    const std::string_view token = reader.nextOnLine();
    if (!token.empty() && !spellsNumber(token, &score))
      throw InputError(path + ": score of plane " + std::to_string(answers.size() + 1) + " = " + std::string(token) +
                       ", must be a number");
    reader.skipLine();
    answers.push_back(Answer::ofPlane(planeFrom(coefficients), score));
    answers.back().rank_only = token.empty();
  }
  return result;
}

}  // namespace

namespace {

/// \param refinement has its input.
PlaneAnswers answersOf(SymmetryMaximaRefinement<pcl::PointXYZ>& refinement, std::uint64_t seed, int num_threads) {
  refinement.setRandomSeed(seed);
  refinement.setNumberOfThreads(num_threads);
  PlaneAnswers result;
  try {
    Stopwatch watch;
    const std::vector<SymmetryPlane> planes = refinement.compute();
    result.milliseconds = watch.lap();
    result.failed = !refinement.getReason().empty();
    for (const SymmetryCenter& center : refinement.getCenters())
      result.answers.push_back(Answer::ofCenter(center.point, center.confidence));
    for (const SymmetryAxis& axis : refinement.getAxes())
      result.answers.push_back(Answer::ofAxis(axis.point, axis.direction, axis.confidence));
    for (const SymmetryPlane& plane : planes) {
      result.answers.push_back(Answer::ofPlane(plane, plane.confidence));
      result.answers.back().called = plane.kind == PlaneKind::Symmetry;
    }
  } catch (const pcl::BadArgumentException&) {
    result.failed = true;
  }
  return result;
}

}  // namespace

PlaneAnswers detectAnswers(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, std::uint64_t seed, int num_threads,
                           double tolerance) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setTolerance(tolerance);
  refinement.setInputCloud(cloud);
  return answersOf(refinement, seed, num_threads);
}

PlaneAnswers detectAnswers(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& scene, const pcl::Indices& cluster,
                           const SeenSpace::ConstPtr& seen, std::uint64_t seed, int num_threads) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setInputCloud(scene);
  refinement.setIndices(pcl::make_shared<pcl::Indices>(cluster));
  refinement.setSeenSpace(seen);
  return answersOf(refinement, seed, num_threads);
}

PlaneAnswers readAnswers(const std::string& folder, const std::string& name) {
  const auto base = boost::filesystem::path(folder) / name;
  for (const std::string extension : {".json", ".txt"}) {
    const std::string path = base.string() + extension;
    if (!boost::filesystem::exists(path)) continue;
    try {
      return extension == ".json" ? answersFromJson(path) : answersFromText(path);
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(path + ": is no list of planes, " + error.what());
    }
  }
  PlaneAnswers missing;
  missing.failed = true;
  return missing;
}

}  // namespace pcl_symmetry::apps
