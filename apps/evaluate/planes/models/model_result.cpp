#include "evaluate/planes/models/model_result.h"

#include <algorithm>
#include <cstdint>

#include "evaluate/references/reference_cache.h"
#include "evaluate/runs/packed_rows.h"

namespace pcl_symmetry::apps {

namespace {

using detail::PackedBytes;
using detail::UnpackedBytes;

void put(PackedBytes& bytes, const MatchResult& match) {
  bytes.put(static_cast<std::uint32_t>(match.judgements.size()));
  for (const Judgement& judgement : match.judgements) bytes.put(judgement);
  for (const int number : {match.num_right, match.num_neutral, match.num_false, match.num_references, match.num_found,
                           match.num_axes_found})
    bytes.put(number);
  putOptional(bytes, match.rank);
  putOptional(bytes, match.first_error);
  putOptional(bytes, match.first_axis_error);
}

void get(UnpackedBytes& bytes, MatchResult& match) {
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) match.judgements.push_back(bytes.get<Judgement>());
  for (int* number : {&match.num_right, &match.num_neutral, &match.num_false, &match.num_references, &match.num_found,
                      &match.num_axes_found})
    *number = bytes.get<int>();
  getOptional(bytes, match.rank);
  getOptional(bytes, match.first_error);
  getOptional(bytes, match.first_axis_error);
}

void put(PackedBytes& bytes, const PlaneAnswers& answers) {
  bytes.put(static_cast<std::uint32_t>(answers.answers.size()));
  for (const Answer& answer : answers.answers) {
    bytes.put(answer.type);
    bytes.put(answer.score);
    bytes.put(answer.rank_only);
    bytes.put(answer.called);
  }
  putOptional(bytes, answers.milliseconds);
  bytes.put(answers.failed);
}

void get(UnpackedBytes& bytes, PlaneAnswers& answers) {
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) {
    Answer answer;
    answer.type = bytes.get<Answer::Type>();
    answer.score = bytes.get<double>();
    answer.rank_only = bytes.get<bool>();
    answer.called = bytes.get<bool>();
    answers.answers.push_back(answer);
  }
  getOptional(bytes, answers.milliseconds);
  answers.failed = bytes.get<bool>();
}

}  // namespace

void put(PackedBytes& bytes, const CloudResult& cloud, const std::vector<CloudRecipe>& recipes) {
  bytes.putText(cloud.model);
  bytes.putText(cloud.cloud);
  const auto recipe = std::find_if(recipes.begin(), recipes.end(),
                                   [&](const CloudRecipe& candidate) { return candidate.name == cloud.recipe.name; });
  bytes.put(static_cast<std::uint32_t>(recipe - recipes.begin()));
  bytes.put(cloud.num_points);
  putOptional(bytes, cloud.view_angle);
  bytes.put(cloud.kind);
  bytes.put(cloud.best_share);
  bytes.put(cloud.num_reference_axes);
  put(bytes, cloud.answers);
  put(bytes, cloud.match);
  bytes.put(cloud.operating_point);
  bytes.put(static_cast<std::uint32_t>(cloud.view_verdicts.size()));
  for (const ViewVerdict verdict : cloud.view_verdicts) bytes.put(verdict);
}

CloudResult cloudFrom(UnpackedBytes& bytes, const std::vector<CloudRecipe>& recipes) {
  CloudResult cloud;
  cloud.model = bytes.text();
  cloud.cloud = bytes.text();
  const auto recipe = bytes.get<std::uint32_t>();
  if (recipe >= recipes.size()) throw std::invalid_argument("recipe = " + std::to_string(recipe) + ", must be known");
  cloud.recipe = recipes[recipe];
  cloud.num_points = bytes.get<std::size_t>();
  getOptional(bytes, cloud.view_angle);
  cloud.kind = bytes.get<SymmetryKind>();
  cloud.best_share = bytes.get<double>();
  cloud.num_reference_axes = bytes.get<int>();
  get(bytes, cloud.answers);
  get(bytes, cloud.match);
  cloud.operating_point = bytes.get<OperatingPoint>();
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left)
    cloud.view_verdicts.push_back(bytes.get<ViewVerdict>());
  return cloud;
}

std::string packedResult(const ModelResult& result, const std::vector<CloudRecipe>& recipes) {
  PackedBytes bytes;
  putOptional(bytes, result.kind);
  bytes.put(result.num_clouds);
  bytes.put(static_cast<std::uint32_t>(result.clouds.size()));
  for (const CloudResult& cloud : result.clouds) put(bytes, cloud, recipes);
  bytes.put(static_cast<std::uint32_t>(result.left_out.size()));
  for (const std::string& reason : result.left_out) bytes.putText(reason);
  bytes.putText(result.found_references ? toJson(*result.found_references).dump() : "");
  bytes.put(result.num_faces);
  bytes.putText(result.ground_truth);
  return bytes.bytes();
}

ModelResult unpackedResult(const std::string& packed, const std::vector<CloudRecipe>& recipes) {
  UnpackedBytes bytes(packed);
  ModelResult result;
  getOptional(bytes, result.kind);
  result.num_clouds = bytes.get<int>();
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) result.clouds.push_back(cloudFrom(bytes, recipes));
  for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) result.left_out.push_back(bytes.text());
  const std::string references = bytes.text();
  if (!references.empty()) result.found_references = referencesFromJson(nlohmann::json::parse(references));
  result.num_faces = bytes.get<std::size_t>();
  result.ground_truth = bytes.text();
  return result;
}

}  // namespace pcl_symmetry::apps
