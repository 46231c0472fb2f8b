#include "recognition/model_folder.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace pcl_symmetry::detail {

namespace fs = std::filesystem;

namespace {

// chosen: names of files and the first line of a manifest; another name would leave older databases unread.
constexpr const char* kManifest = "manifest.txt";
constexpr const char* kNewManifest = "manifest.txt.new";
constexpr const char* kHeader = "pcl_symmetry database 2";
// Characters. chosen: names with number and extension stay below the 255 bytes that file systems allow; half would be
// enough for most names, twice leaves little room.
constexpr std::size_t kLongestName = 100;
constexpr const char* kModelExtensions[] = {".pcd", ".signature", ".views"};
constexpr const char* kCommonExtensions[] = {".projection", ".compact"};
constexpr const char* kCommonName = "all";

/// True for the names that freeFileName() makes: a number, "_" and the name of a model.
bool isFileName(const std::string& file) {
  const std::size_t end = file.find('_');
  return end != std::string::npos && end > 0 &&
         std::all_of(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(end),
                     [](unsigned char c) { return std::isdigit(c); }) &&
         isModelName(file.substr(end + 1));
}

/// \throws std::invalid_argument with the reason.
Manifest parseManifest(std::istream& text) {
  std::string header;
  std::getline(text, header);
  if (header != kHeader) throw std::invalid_argument(std::string("must begin with '") + kHeader + "'");
  Manifest manifest;
  std::size_t num_models = 0;
  if (!(text >> manifest.next_file >> manifest.num_references >> manifest.common_file >> num_models))
    throw std::invalid_argument("second line: must be two counts, a file and a count");
  if (!isFileName(manifest.common_file)) throw std::invalid_argument("second line: the file must be NUMBER_NAME");
  for (std::size_t i = 0; i < num_models; ++i) {
    std::string name, file;
    if (!(text >> name >> file) || !isModelName(name) || !isFileName(file))
      throw std::invalid_argument("model " + std::to_string(i + 1) + ": must be a name and a file NUMBER_NAME");
    manifest.files[name] = file;
  }
  return manifest;
}

}  // namespace

bool isModelName(const std::string& name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; });
}

std::set<std::string> Manifest::allFiles() const {
  std::set<std::string> all;
  for (const auto& [name, file] : files)
    for (const char* extension : kModelExtensions) all.insert(file + extension);
  if (!common_file.empty())
    for (const char* extension : kCommonExtensions) all.insert(common_file + extension);
  return all;
}

ModelFolder::ModelFolder(const std::string& path) : path_(path) {
  std::error_code error;
  if (!exists(kManifest)) {
    if (fs::exists(path_, error) && (!fs::is_directory(path_, error) || !fs::is_empty(path_, error)) &&
        !exists(kNewManifest))
      failIO(path_, std::string("must be a new or empty folder, or one with a ") + kManifest);
    return;
  }
  std::ifstream text(pathOf(kManifest));
  try {
    manifest_ = parseManifest(text);
  } catch (const std::invalid_argument& reason) {
    failIO(pathOf(kManifest), reason.what());
  }
}

std::string ModelFolder::pathOf(const std::string& file) const {
  return (fs::path(path_) / file).string();
}

bool ModelFolder::exists(const std::string& file) const {
  std::error_code error;
  return fs::exists(pathOf(file), error);
}

SignatureProjection ModelFolder::projection() const {
  if (manifest_.files.empty()) return {};
  const std::string path = pathOf(manifest_.common_file + ".projection");
  try {
    return SignatureProjection::fromValues(readFloats(path));
  } catch (const std::invalid_argument& reason) {
    failIO(path, reason.what());
  }
}

Models ModelFolder::models(const SignatureProjection& projection) const {
  Models models;
  if (manifest_.files.empty()) return models;
  const std::string path = pathOf(manifest_.common_file + ".compact");
  const std::vector<float> values = readFloats(path);
  const Eigen::Index dimensions = projection.numDimensions();
  const std::size_t size_of_model = static_cast<std::size_t>(dimensions) * kFormsPerModel;
  if (values.size() != size_of_model * manifest_.files.size())
    failIO(path, "has another number of models than the manifest");
  const float* next = values.data();
  for (const auto& [name, file] : manifest_.files) {
    Model& model = models[name];
    model.file = file;
    model.compact = Eigen::Map<const Eigen::MatrixXf>(next, dimensions, kFormsPerModel);
    next += size_of_model;
  }
  return models;
}

PositionCloud ModelFolder::cloud(const Model& model) const {
  return model.file.empty() ? model.cloud : readCloud(pathOf(model.file + ".pcd"));
}

Eigen::MatrixXf ModelFolder::signatures(const Model& model) const {
  if (model.file.empty()) return model.signatures;
  const std::string path = pathOf(model.file + ".signature");
  const std::vector<float> values = readFloats(path);
  if (values.size() != static_cast<std::size_t>(kSignatureSize) * kFormsPerModel) failIO(path, "is incomplete");
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), kSignatureSize, kFormsPerModel);
}

std::vector<View> ModelFolder::views(const Model& model) const {
  return model.file.empty() ? model.views : readViews(pathOf(model.file + ".views"));
}

void ModelFolder::save(Models& models, const SignatureProjection& projection, int num_references) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) failIO(path_, error.message());
  if (const std::optional<Manifest> interrupted = interruptedSave()) removeFiles(*interrupted);

  const Manifest next = nextManifest(models, num_references);
  writeManifest(kNewManifest, next);
  for (const auto& [name, model] : models)
    if (model.file.empty()) writeModel(next.files.at(name), model);
  writeCompactForms(next.common_file, models, projection);
  fs::rename(pathOf(kNewManifest), pathOf(kManifest), error);
  if (error) failIO(pathOf(kManifest), error.message());

  const Manifest outdated = std::exchange(manifest_, next);
  removeFiles(outdated);
  for (auto& [name, model] : models) {
    model.file = next.files.at(name);
    model.cloud.clear();
    model.signatures.resize(0, 0);
    model.views.clear();
  }
}

/// The manifest of a save that did not reach its end. It counts only where it is complete: no file was written before.
std::optional<Manifest> ModelFolder::interruptedSave() const {
  std::ifstream file(pathOf(kNewManifest), std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (content.empty() || content.back() != '\n') return std::nullopt;
  std::istringstream text(content);
  try {
    return parseManifest(text);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// Gives each model that is not stored yet, and the compact forms of all, file names that no file in the folder has.
Manifest ModelFolder::nextManifest(const Models& models, int num_references) const {
  Manifest next = manifest_;
  const auto freeFileName = [&](const std::string& name, const auto& extensions) {
    for (;;) {
      const std::string file = std::to_string(next.next_file++) + "_" + name;
      if (std::none_of(std::begin(extensions), std::end(extensions),
                       [&](const char* extension) { return exists(file + extension); }))
        return file;
    }
  };
  next.num_references = num_references;
  next.files.clear();
  for (const auto& [name, model] : models)
    next.files[name] = model.file.empty() ? freeFileName(name, kModelExtensions) : model.file;
  next.common_file = freeFileName(kCommonName, kCommonExtensions);
  return next;
}

void ModelFolder::writeManifest(const std::string& file, const Manifest& manifest) const {
  std::ofstream text(pathOf(file));
  text << kHeader << '\n'
       << manifest.next_file << ' ' << manifest.num_references << ' ' << manifest.common_file << ' '
       << manifest.files.size() << '\n';
  for (const auto& [name, model_file] : manifest.files) text << name << ' ' << model_file << '\n';
  text.close();
  if (!text) failIO(pathOf(file), "cannot be written");
}

void ModelFolder::writeModel(const std::string& file, const Model& model) const {
  const Eigen::MatrixXf& values = model.signatures;
  writeCloud(pathOf(file + ".pcd"), model.cloud);
  writeFloats(pathOf(file + ".signature"), std::vector<float>(values.data(), values.data() + values.size()));
  writeViews(pathOf(file + ".views"), model.views);
}

void ModelFolder::writeCompactForms(const std::string& file, const Models& models,
                                    const SignatureProjection& projection) const {
  writeFloats(pathOf(file + ".projection"), projection.toValues());
  std::vector<float> compact;
  for (const auto& [name, model] : models)
    compact.insert(compact.end(), model.compact.data(), model.compact.data() + model.compact.size());
  writeFloats(pathOf(file + ".compact"), compact);
}

/// Removes the files of another manifest that the current one does not name.
void ModelFolder::removeFiles(const Manifest& outdated) const {
  const std::set<std::string> kept = manifest_.allFiles();
  std::error_code error;  // a file that cannot be removed does no harm
  for (const std::string& file : outdated.allFiles())
    if (!kept.count(file)) fs::remove(pathOf(file), error);
}

}  // namespace pcl_symmetry::detail
