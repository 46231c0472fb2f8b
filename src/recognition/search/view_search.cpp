#include "recognition/search/view_search.h"

#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/base/parallel.h"
#include "recognition/packing/packed_model.h"
#include "recognition/storage/io_error.h"

namespace pcl_symmetry::detail {

ViewSearch::ViewSearch(ModelStore& store, int num_threads) : models_(store.models()) {
  std::vector<std::vector<View>> views(models_.size());
  std::mutex mutex;
  parallelBlocks(models_.size(), num_threads, [&](std::size_t i) {
    const std::string bytes = [&] {
      const std::lock_guard<std::mutex> lock(mutex);
      return store.part(ModelPart::Views, models_[i]);
    }();
    try {
      views[i] = unpackedViews(bytes);
    } catch (const std::invalid_argument& error) {
      failIO(store.file(), "the views of model '" + models_[i].name + "' " + error.what());
    }
  });
  for (std::vector<View>& of_model : views) index_.add(std::exchange(of_model, {}));
}

std::vector<ModelOfView> ViewSearch::nearest(const View& scan, const ViewSearchOptions& options) const {
  std::vector<ModelOfView> found;
  for (ShapeOfView& shape : index_.nearest(scan, options))
    found.push_back({models_[static_cast<std::size_t>(shape.shape)], std::move(shape.T_shape_scan)});
  return found;
}

}  // namespace pcl_symmetry::detail
