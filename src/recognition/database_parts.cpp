#include "recognition/database_parts.h"

#include <boost/locale/utf.hpp>
#include <ctime>
#include <utility>

#include "core/geometry/point_samples.h"
#include "core/matching/matching_rules.h"
#include "core/matching/shape_signature.h"
#include "core/matching/view_signature.h"

namespace pcl_symmetry::detail {

namespace {

bool isUTF8(const std::string& text) {
  namespace utf = boost::locale::utf;
  for (auto at = text.begin(); at != text.end();)
    if (!utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, text.end()))) return false;
  return true;
}

}  // namespace

std::int64_t currentTime() {
  return static_cast<std::int64_t>(std::time(nullptr));
}

void checkModelName(const std::string& name) {
  bool good = !name.empty() && name.size() <= 200 && name.front() != '.' && isUTF8(name);
  for (const unsigned char c : name) good = good && c >= 0x20 && c != 0x7f && c != '/';
  if (good) return;
  constexpr std::size_t most_shown = 40;
  std::string shown = name.substr(0, most_shown) + (name.size() > most_shown ? "..." : "");
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  throw std::invalid_argument(
      "name = '" + shown + "' (" + std::to_string(name.size()) +
      " bytes), must be 1 to 200 bytes of UTF-8 without '/' and control characters, not '.' first");
}

DescribedModel describedModel(const Points& points, const DatabaseOptions& options) {
  if (const std::string reason = reasonForNoAnswer(points); !reason.empty()) throw std::invalid_argument(reason);
  DescriptionOptions description;
  description.num_threads = options.num_threads;
  DescribedModel model;
  model.signatures = describeShape(points, description).signatures;
  model.packed.signatures = packedSignatures(model.signatures);
  model.packed.views = packedViews(viewsAround(points, options.num_views, options.num_threads));
  const Points some = pointsAt(points, drawSamples(points.cols(), kMatching.num_surface_points, 1));
  model.packed.surfaces =
      packedSurfaces(evenSurfacePoints(some, {kMatching.num_pair_points, kMatching.num_screened_points}, 1));
  PositionCloud cloud(static_cast<std::uint32_t>(points.cols()), 1);
  cloud.getMatrixXfMap(3, 4, 0) = points;
  model.packed.cloud = packedCloud(cloud);
  model.packed.num_points = cloud.size();
  return model;
}

FittedForms DatabaseParts::storedForms() {
  const std::int64_t id = store.projectionId();
  if (id == forms_.id) return forms_;
  try {
    return forms_ = id == 0 ? FittedForms() : FittedForms::unpacked(store.projection().value());
  } catch (const std::invalid_argument& error) {
    failIO(store.file(), std::string("the projection ") + error.what());
  }
}

template <typename Search>
std::shared_ptr<const Search> DatabaseParts::latest(std::shared_ptr<const Search>& made,
                                                    std::uint64_t& version_of_made) {
  const std::lock_guard<std::mutex> lock(mutex);
  const std::uint64_t version = store.version();
  if (version_of_made != version) made.reset();  // before reading: both together would take twice the memory
  if (!made) made = std::make_shared<const Search>(store, storedForms(), options);
  version_of_made = version;
  return made;
}

std::shared_ptr<const ShapeSearch> DatabaseParts::shapes() {
  return latest(shapes_, shapes_version_);
}

std::shared_ptr<const ViewSearch> DatabaseParts::views() {
  return latest(views_, views_version_);
}

std::shared_ptr<const PairSearch> DatabaseParts::pairs() {
  std::unique_lock<std::mutex> lock(mutex);
  const std::uint64_t version = store.version();
  if (pairs_version_ == version) return pairs_;
  if (store.models().size() > kRecognition.max_pair_models) return pairs_ = nullptr;
  const std::vector<StoredModel> models = store.models();
  const std::shared_ptr<const PairSearch> before = pairs_;
  lock.unlock();  // models are read under the lock, one at a time
  const auto read = [&](const StoredModel& model) { return shape(model); };
  const auto made = std::make_shared<const PairSearch>(models, read, before.get(), options.num_threads);
  lock.lock();
  pairs_version_ = version;
  return pairs_ = made;
}

PositionCloud DatabaseParts::cloud(const StoredModel& model) {
  return unpackedPart(store, ModelPart::Cloud, "cloud", model, mutex, unpackedCloud);
}

Points DatabaseParts::points(const StoredModel& model, std::size_t max_points) {
  return finitePoints(cloud(model), max_points);
}

std::shared_ptr<const ModelShape> DatabaseParts::shape(const StoredModel& model) {
  return unpackedPart(store, ModelPart::Surfaces, "surfaces", model, mutex, [](const std::string& bytes) {
    std::vector<SurfacePoints> surfaces = unpackedSurfaces(bytes);
    if (surfaces.size() != 2) throw std::invalid_argument("have another number than two");
    return std::make_shared<const ModelShape>(ModelShape{std::move(surfaces[0]), ScreenedSurface(surfaces[1])});
  });
}

void DatabaseParts::add(const ModelInfo& info, const PackedModel& model, const Eigen::MatrixXf& signatures) {
  const std::lock_guard<std::mutex> lock(mutex);
  const FittedForms stored = storedForms();
  PackedForms forms;
  if (stored.id != 0)
    forms = {0, stored.forms->formOf(signatures, 0).packed(), stored.coder->codesOf(unpackedViews(model.views))};
  store.add(info, model, stored.id, std::move(forms));
}

void DatabaseParts::save() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (store.size() == 0) return;
    const FittedForms stored = storedForms();
    if (stored.isOf(referencesOf(store, options.num_references))) {
      const std::vector<StoredModel> without = store.modelsWithoutForms();
      if (without.empty()) return;
      store.addForms(stored.id,
                     formsOfModels(store, without, stored.forms.get(), stored.coder.get(), options.num_threads));
      return;
    }
  }
  rebuild();
}

void DatabaseParts::rebuild() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (store.size() == 0) return;
  const FittedForms fitted{0, fitForms(store, options.num_references, options.num_threads),
                           fitViewCoder(store, options.num_references, options.num_threads)};
  store.setProjection(fitted.packed(), formsOfModels(store, store.models(), fitted.forms.get(), fitted.coder.get(),
                                                     options.num_threads));
}

}  // namespace pcl_symmetry::detail
