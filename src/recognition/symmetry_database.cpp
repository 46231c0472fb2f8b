#include "pcl_symmetry/recognition/symmetry_database.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/impl/bad_argument.hpp"
#include "pcl_symmetry/impl/point_selection.hpp"
#include "pcl_symmetry/impl/seen_space.hpp"

namespace pcl_symmetry {

namespace fs = std::filesystem;

namespace {

constexpr int kFormsPerModel = 2;
constexpr const char* kManifest = "manifest.txt";
constexpr const char* kHeader = "pcl_symmetry database 1";
constexpr double kSeenRadius = 0.95;      // of a scan's bounding ball, of that of its whole object, typically
constexpr double kMeritSharpness = 20.0;  // of the soft maximum of merits
constexpr int kSizeCandidates = 5;        // times as many as are verified, that sizes are compared of

void check(bool valid, const char* field, double value, const char* rule) {
  if (valid) return;
  std::ostringstream message;
  message << field << " = " << value << ", must be " << rule;
  throw std::invalid_argument(message.str());
}

[[noreturn]] void failIO(const std::string& file, const std::string& why) {
  PCL_THROW_EXCEPTION(pcl::IOException, file << ": " << why);
}

void checkName(const std::string& name) {
  constexpr std::size_t kLongest = 100;
  const bool valid = !name.empty() && name.size() <= kLongest && name.front() != '.' &&
                     std::all_of(name.begin(), name.end(),
                                 [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; });
  if (!valid)
    throw std::invalid_argument("name = '" + name +
                                "', must be 1 to 100 letters, digits, '_', '-' or '.', not '.' first");
}

void writeFloats(const std::string& path, const std::vector<float>& values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float)));
  file.close();
  if (!file) failIO(path, "cannot be written");
}

std::vector<float> readFloats(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) failIO(path, error.message());
  std::vector<float> values(static_cast<std::size_t>(size / sizeof(float)));
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float))))
    failIO(path, "cannot be read");
  return values;
}

/// A PCD file of x, y and z. (PCL's own writer is in a library that needs VTK and drivers of cameras.)
void writeCloud(const std::string& path, const SymmetryDatabase::Cloud& cloud) {
  std::ofstream file(path, std::ios::binary);
  file << "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << cloud.size()
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << cloud.size() << "\nDATA binary\n";
  for (const pcl::PointXYZ& point : cloud) file.write(reinterpret_cast<const char*>(point.data), 3 * sizeof(float));
  file.close();
  if (!file) failIO(path, "cannot be written");
}

/// \param path of a file of writeCloud().
SymmetryDatabase::Cloud readCloud(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::size_t size = 0;
  std::string line;
  while (std::getline(file, line) && line != "DATA binary")
    if (line.rfind("POINTS ", 0) == 0) size = std::strtoull(line.c_str() + 7, nullptr, 10);
  if (!file || size == 0) failIO(path, "cannot be read, must be a PCD file of this database");
  SymmetryDatabase::Cloud cloud(static_cast<std::uint32_t>(size), 1);
  for (pcl::PointXYZ& point : cloud) file.read(reinterpret_cast<char*>(point.data), 3 * sizeof(float));
  if (!file) failIO(path, "is incomplete");
  return cloud;
}

Points finitePoints(const SymmetryDatabase::Cloud& cloud, std::size_t max_points) {
  return selectPoints(cloud, nullptr, max_points, 1).points;
}

}  // namespace

void DatabaseOptions::validate() const {
  check(num_references >= 1, "num_references", num_references, ">= 1");
  check(max_points >= 100, "max_points", static_cast<double>(max_points), ">= 100");
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
}

CloudRegistrationOptions RecognitionOptions::quickRegistration() {
  CloudRegistrationOptions options;
  options.frame = signatureFrameOptions();
  options.search.num_rotations = 200;
  options.search.num_screened = 16;
  options.search.num_refined = 6;
  options.search.max_poses = 2;
  return options;
}

void RecognitionOptions::validate() const {
  check(num_candidates >= 1, "num_candidates", num_candidates, ">= 1");
  check(size_weight >= 0.0, "size_weight", size_weight, ">= 0");
  check(min_merit >= -1.0 && min_merit <= 1.0, "min_merit", min_merit, "in [-1, 1]");
  check(num_threads >= 0, "num_threads", num_threads, ">= 0");
  registration.validate();
}

SymmetryDatabase::SymmetryDatabase(const std::string& folder, const DatabaseOptions& options)
    : folder_(folder), options_(options) {
  withBadArguments([&] { options.validate(); });
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
    if (!(manifest >> name >> model.file >> model.radius))
      failIO(path(kManifest), "model " + std::to_string(i + 1) + ", must be a name, a file and a radius");
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
  withBadArguments([&] {
    checkName(name);
    const Points points = finitePoints(cloud, options_.max_points);
    DescriptionOptions description;
    description.num_threads = options_.num_threads;
    Model model;
    model.signatures = describeShape(points, description).signatures;
    model.radius = boundingBall(points).radius;
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
    projection_ = withBadArguments([&] { return SignatureProjection::fit(references, projection); });
  }
  fillIndex();
}

void SymmetryDatabase::storeModel(const std::string& name, Model& model) {
  const std::string file = std::to_string(next_file_++) + "_" + name;
  writeCloud(path(file + ".pcd"), model.cloud);
  const Eigen::MatrixXf& values = model.signatures;
  writeFloats(path(file + ".signature"), std::vector<float>(values.data(), values.data() + values.size()));
  model.file = file;
  model.cloud.clear();
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
    manifest.precision(std::numeric_limits<double>::max_digits10);
    manifest << kHeader << '\n'
             << next_file_ << ' ' << num_fitted_ << ' ' << projection_file_ << ' ' << models_.size() << '\n';
    for (const auto& [name, model] : models_) manifest << name << ' ' << model.file << ' ' << model.radius << '\n';
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
    const bool own =
        extension == ".pcd" || extension == ".signature" || extension == ".projection" || extension == ".compact";
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
  return withBadArguments([&] {
    const Points points = finitePoints(cloud, options_.max_points);
    const std::optional<Visibility> seen = seenSpace(cloud, points, viewpoint);
    std::vector<ModelMatch> matches;
    for (const auto& [model, distance] : nearest(points, seen ? &*seen : nullptr, num_nearest))
      matches.push_back({indexed_[static_cast<std::size_t>(model)], distance});
    return matches;
  });
}

Recognition SymmetryDatabase::recognize(const Cloud& scan, const RecognitionOptions& options,
                                        const Viewpoint& viewpoint) const {
  return withBadArguments([&] {
    options.validate();
    const Points points = finitePoints(scan, options_.max_points);
    const std::optional<Visibility> seen = seenSpace(scan, points, viewpoint);
    const double radius = boundingBall(points).radius / kSeenRadius;
    // Sizes tell models apart that signatures of one side alone do not: all models are asked where there is a unit.
    const int num_asked = options.size_weight > 0.0 ? static_cast<int>(indexed_.size())
                                                    : std::min<int>(options.num_candidates * kSizeCandidates,
                                                                    static_cast<int>(indexed_.size()));
    std::vector<std::pair<double, std::string>> candidates;
    for (const auto& [model, distance] : nearest(points, seen ? &*seen : nullptr, num_asked)) {
      const std::string& name = indexed_[static_cast<std::size_t>(model)];
      const double size = std::abs(std::log(radius / models_.at(name).radius));
      candidates.emplace_back(distance + options.size_weight * size, name);
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    candidates.resize(std::min(candidates.size(), static_cast<std::size_t>(options.num_candidates)));

    CloudRegistrationOptions registration = options.registration;
    registration.num_threads = options.num_threads;
    constexpr std::size_t kScanPoints = 10'000;
    const Points scan_points = finitePoints(scan, kScanPoints);
    Recognition found;
    for (const auto& [distance, name] : candidates) {
      const CloudRegistration posed = registerClouds(scan_points, seen, finitePoints(cloud(name), kScanPoints), {},
                                                     Eigen::Isometry3d::Identity(), registration);
      if (posed.score.merit() >= options.min_merit) found.push_back({name, posed.T_target_source, posed.score, 0.0});
    }
    std::stable_sort(found.begin(), found.end(), [](const RecognizedModel& a, const RecognizedModel& b) {
      return a.score.merit() > b.score.merit();
    });
    double sum = 0.0;
    for (const RecognizedModel& model : found) sum += std::exp(kMeritSharpness * model.score.merit());
    for (RecognizedModel& model : found) {
      const double merit = model.score.merit();
      const double above = options.min_merit < 1.0 ? (merit - options.min_merit) / (1.0 - options.min_merit) : 1.0;
      model.confidence = std::exp(kMeritSharpness * merit) / sum * std::sqrt(std::clamp(above, 0.0, 1.0));
    }
    return found;
  });
}

}  // namespace pcl_symmetry
