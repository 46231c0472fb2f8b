#include "pcl_symmetry/recognition/symmetry_database.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "database_files.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"

namespace pcl_symmetry {

namespace fs = std::filesystem;

namespace {

constexpr int kFormsPerModel = 2;
constexpr const char* kManifest = "manifest.txt";
constexpr const char* kHeader = "pcl_symmetry database 2";

void checkName(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  const bool valid = !name.empty() && name.size() <= kLongest && name.front() != '.' &&
                     std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; });
  if (!valid)
    throw std::invalid_argument("name = '" + name +
                                "', must be 1 to 100 letters, digits, '_', '-' or '.', not '.' first");
}

Points finitePoints(const SymmetryDatabase::Cloud& cloud, std::size_t max_points) {
  return detail::selectPoints(cloud, nullptr, max_points, 1).points;
}

}  // namespace

void DatabaseOptions::validate() const {
  check(num_references >= 1, "num_references", num_references, ">= 1");
  check(num_views >= 1, "num_views", num_views, ">= 1");
  check(max_points >= 100, "max_points", static_cast<double>(max_points), ">= 100");
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
}

SymmetryDatabase::SymmetryDatabase(const std::string& folder, const DatabaseOptions& options)
    : folder_(folder), options_(options) {
  detail::withBadArguments([&] { options.validate(); });
  load();
}

std::string SymmetryDatabase::path(const std::string& file) const {
  return (fs::path(folder_) / file).string();
}

void SymmetryDatabase::load() {
  std::error_code error;
  if (!fs::exists(path(kManifest), error)) {
    if (fs::exists(folder_, error) && (!fs::is_directory(folder_, error) || !fs::is_empty(folder_, error)))
      failIO(folder_, std::string("must be a new or empty folder, or one with a ") + kManifest);
    return;
  }
  std::ifstream manifest(path(kManifest));
  std::string line;
  std::size_t num_models = 0;
  std::getline(manifest, line);
  if (line != kHeader) failIO(path(kManifest), std::string("must begin with '") + kHeader + "'");
  if (!(manifest >> next_file_ >> num_fitted_ >> projection_file_ >> num_models))
    failIO(path(kManifest), "second line, must be two counts, a file and a count");
  for (std::size_t i = 0; i < num_models; ++i) {
    std::string name;
    Model model;
    if (!(manifest >> name >> model.file))
      failIO(path(kManifest), "model " + std::to_string(i + 1) + ", must be a name and a file");
    models_[name] = model;
  }
  if (num_models > 0) loadCompactForms();
}

void SymmetryDatabase::loadCompactForms() {
  try {
    projection_ = SignatureProjection::fromValues(readFloats(path(projection_file_ + ".projection")));
  } catch (const std::invalid_argument& why) {
    failIO(path(projection_file_ + ".projection"), why.what());
  }
  const std::vector<float> values = readFloats(path(projection_file_ + ".compact"));
  const Eigen::Index dimensions = projection_.numDimensions();
  const std::size_t size_of_model = static_cast<std::size_t>(dimensions) * kFormsPerModel;
  if (values.size() != size_of_model * models_.size())
    failIO(path(projection_file_ + ".compact"), "has another number of models than the manifest");
  const float* next = values.data();
  for (auto& [name, model] : models_) {
    model.compact = Eigen::Map<const Eigen::MatrixXf>(next, dimensions, kFormsPerModel);
    next += size_of_model;
  }
  fillIndex();
}

/// Of all models, of which those that are new get their compact forms.
void SymmetryDatabase::fillIndex() {
  indexed_ = names();
  parallelBlocks(indexed_.size(), options_.num_threads, [&](std::size_t i) {
    Model& model = models_.at(indexed_[i]);
    if (model.compact.size() == 0) model.compact = projection_.project(signatures(model));
  });
  Eigen::MatrixXf all(projection_.numDimensions(), kFormsPerModel * static_cast<Eigen::Index>(indexed_.size()));
  for (std::size_t i = 0; i < indexed_.size(); ++i)
    all.middleCols(kFormsPerModel * static_cast<Eigen::Index>(i), kFormsPerModel) = models_.at(indexed_[i]).compact;
  view_index_ = {};
  for (const std::string& name : indexed_) view_index_.add(views(models_.at(name)));
  CompactIndexOptions index_options;
  index_options.num_threads = options_.num_threads;
  index_ = CompactIndex(std::move(all), kFormsPerModel, index_options);
}

std::vector<std::string> SymmetryDatabase::names() const {
  std::vector<std::string> names;
  for (const auto& [name, model] : models_) names.push_back(name);
  return names;
}

void SymmetryDatabase::add(const std::string& name, const Cloud& cloud) {
  detail::withBadArguments([&] {
    checkName(name);
    const Points points = finitePoints(cloud, options_.max_points);
    DescriptionOptions description;
    description.num_threads = options_.num_threads;
    Model model;
    model.signatures = describeShape(points, description).signatures;
    model.views = viewsAround(points, options_.num_views, options_.num_threads);
    model.cloud.resize(static_cast<std::size_t>(points.cols()));
    model.cloud.getMatrixXfMap(3, 4, 0) = points;
    models_[name] = std::move(model);
    changed_ = true;
  });
}

void SymmetryDatabase::remove(const std::string& name) {
  if (models_.erase(name) == 0) PCL_THROW_EXCEPTION(pcl::BadArgumentException, "name = '" << name << "', is no model");
  changed_ = true;
}

Eigen::MatrixXf SymmetryDatabase::signatures(const Model& model) const {
  if (model.signatures.size() > 0) return model.signatures;
  const std::vector<float> values = readFloats(path(model.file + ".signature"));
  if (values.size() != static_cast<std::size_t>(kSignatureSize) * kFormsPerModel)
    failIO(path(model.file + ".signature"), "is incomplete");
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), kSignatureSize, kFormsPerModel);
}

std::vector<View> SymmetryDatabase::views(const Model& model) const {
  return model.views.empty() ? readViews(path(model.file + ".views")) : model.views;
}

void SymmetryDatabase::rebuild() {
  changed_ = true;
  projection_ = {};
  num_fitted_ = static_cast<int>(std::min<std::size_t>(models_.size(), options_.num_references));
  std::vector<Model*> all;
  for (auto& [name, model] : models_) {
    model.compact.resize(0, 0);
    all.push_back(&model);
  }
  if (!all.empty()) {
    Eigen::MatrixXf references(kSignatureSize, num_fitted_);
    parallelBlocks(static_cast<std::size_t>(num_fitted_), options_.num_threads, [&](std::size_t r) {
      const Model& model = *all[r * all.size() / static_cast<std::size_t>(num_fitted_)];
      references.col(static_cast<Eigen::Index>(r)) = signatures(model).col(0);
    });
    ProjectionOptions projection;
    projection.num_threads = options_.num_threads;
    projection_ = detail::withBadArguments([&] { return SignatureProjection::fit(references, projection); });
  }
  fillIndex();
}

void SymmetryDatabase::storeModel(const std::string& name, Model& model) {
  const std::string file = std::to_string(next_file_++) + "_" + name;
  writeCloud(path(file + ".pcd"), model.cloud);
  const Eigen::MatrixXf& values = model.signatures;
  writeFloats(path(file + ".signature"), std::vector<float>(values.data(), values.data() + values.size()));
  writeViews(path(file + ".views"), model.views);
  model.file = file;
  model.cloud.clear();
  model.views.clear();
  model.signatures.resize(0, 0);
}

void SymmetryDatabase::save() {
  if (!changed_) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) failIO(folder_, error.message());
  const int wanted = static_cast<int>(std::min<std::size_t>(models_.size(), options_.num_references));
  if (projection_.empty() || 2 * num_fitted_ < wanted)
    rebuild();
  else
    fillIndex();
  for (auto& [name, model] : models_)
    if (model.file.empty()) storeModel(name, model);
  projection_file_ = std::to_string(next_file_++) + "_all";
  writeFloats(path(projection_file_ + ".projection"), projection_.toValues());
  std::vector<float> compact;
  for (const auto& [name, model] : models_)
    compact.insert(compact.end(), model.compact.data(), model.compact.data() + model.compact.size());
  writeFloats(path(projection_file_ + ".compact"), compact);
  const std::string temporary = path(std::string(kManifest) + ".new");
  {
    std::ofstream manifest(temporary);
    manifest << kHeader << '\n'
             << next_file_ << ' ' << num_fitted_ << ' ' << projection_file_ << ' ' << models_.size() << '\n';
    for (const auto& [name, model] : models_) manifest << name << ' ' << model.file << '\n';
    manifest.close();
    if (!manifest) failIO(temporary, "cannot be written");
  }
  fs::rename(temporary, path(kManifest), error);
  if (error) failIO(path(kManifest), error.message());
  changed_ = false;
  removeStrayFiles();
}

/// Files that the manifest does not name: of models that were removed, or of changes that were interrupted.
void SymmetryDatabase::removeStrayFiles() const {
  std::set<std::string> kept = {projection_file_};
  for (const auto& [name, model] : models_) kept.insert(model.file);
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, error)) {
    const std::string extension = entry.path().extension().string();
    const bool own = extension == ".pcd" || extension == ".signature" || extension == ".views" ||
                     extension == ".projection" || extension == ".compact";
    if (own && !kept.count(entry.path().stem().string())) fs::remove(entry.path(), error);
  }
}

SymmetryDatabase::Cloud SymmetryDatabase::cloud(const std::string& name) const {
  const auto model = models_.find(name);
  if (model == models_.end()) PCL_THROW_EXCEPTION(pcl::BadArgumentException, "name = '" << name << "', is no model");
  if (model->second.file.empty()) return model->second.cloud;
  return readCloud(path(model->second.file + ".pcd"));
}

std::vector<std::pair<int, float>> SymmetryDatabase::nearest(const Points& points, const Visibility* seen,
                                                             int count) const {
  DescriptionOptions description;
  description.num_threads = options_.num_threads;
  const Eigen::MatrixXf own = describeShape(points, description, seen).signatures;
  return projection_.empty() ? std::vector<std::pair<int, float>>()
                             : index_.nearest(projection_.rotations(projection_.project(own)), count);
}

std::vector<ModelMatch> SymmetryDatabase::match(const Cloud& cloud, int num_nearest, const Viewpoint& viewpoint) const {
  return detail::withBadArguments([&] {
    const Points points = finitePoints(cloud, options_.max_points);
    const std::optional<Visibility> seen = detail::seenSpace(cloud, points, viewpoint);
    std::vector<ModelMatch> matches;
    for (const auto& [model, distance] : nearest(points, seen ? &*seen : nullptr, num_nearest))
      matches.push_back({indexed_[static_cast<std::size_t>(model)], distance});
    return matches;
  });
}

}  // namespace pcl_symmetry
