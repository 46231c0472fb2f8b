/// The entry of the module pcl_symmetry_drawing.so.
#include <mutex>
#include <string>

#include "pictures/chart_drawing.h"
#include "pictures/image_files.h"
#include "pictures/scene_drawing.h"
#include "common/modules/drawing.h"

namespace {

using namespace pcl_symmetry::apps;

/// VTK has global state, and a picture may start a display of its own: one thread at a time.
class VTKDrawing : public Drawing {
public:
  void drawScenes(const std::vector<PictureScene>& scenes, const PictureTarget& target,
                  int num_columns) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    pcl_symmetry::apps::drawScenes(scenes, target, num_columns);
  }
  void drawChart(const Chart& chart, const PictureTarget& target) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    pcl_symmetry::apps::drawChart(chart, target);
  }
  RasterImage decodeImage(const std::string& path, bool png) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    return pcl_symmetry::apps::decodeImage(path, png);
  }
  void encodeImage(const RasterImage& image, const std::string& path, const std::string& file) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    pcl_symmetry::apps::encodeImage(image, path, file);
  }
  void encodeVolume(const VolumeImage& volume, const std::string& path, const std::string& file) const override {
    const std::lock_guard<std::mutex> lock(mutex_);
    pcl_symmetry::apps::encodeVolume(volume, path, file);
  }

private:
  mutable std::mutex mutex_;
};

}  // namespace

extern "C" const void* pclSymmetryModule(const char* version) {
  static const VTKDrawing drawing;
  return std::string(version) == PCL_SYMMETRY_VERSION ? static_cast<const Drawing*>(&drawing) : nullptr;
}
