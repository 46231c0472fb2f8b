#include "viewer/viewer_window.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "io/answers.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pictures/picture_actors.h"
#include "viewer/isp_frames.h"
#include "viewer/viewer_canvas.h"

namespace pcl_symmetry::apps {

namespace {

using namespace viewer_colors;

constexpr double kFaintSize = 2.0;  // pixels

/// The direction that a key asked for; none: the camera stays.
std::optional<Eigen::Vector3d> viewDirection(const ViewerModel& model, const ViewerState& state) {
  switch (state.camera) {
    case CameraMove::Stay:
      break;
    case CameraMove::Best:
      return model.views.getBestView().direction;
    case CameraMove::Worst:
      return model.views.getWorstView().direction;
    case CameraMove::Along: {
      const Eigen::Vector3d n =
          state.num_planes > 0 ? model.planes[state.plane].normal() : Eigen::Vector3d(Eigen::Vector3d::UnitX());
      const Eigen::Vector3d along = n.cross(model.views.getUpAxis());
      return along.norm() > 0.2 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d(n.unitOrthogonal());
    }
  }
  return std::nullopt;
}

class ModelWindow : public ViewerWindow {
public:
  ModelWindow(const ViewerModel& model, const std::string& name, bool off_screen, int width, int height)
      : model_(model),
        name_(name),
        canvas_(name, off_screen, width, height, [this](const std::string& symbol) { press(symbol); }) {
    state_.num_planes = static_cast<int>(model.planes.size());
    state_.has_mesh = model.mesh.has_value();
    // Support on a mesh of few vertices would be lost between them.
    constexpr std::size_t kFineMesh = 2'000;  // vertices
    state_.mesh = state_.has_mesh && model.mesh->cloud.width * model.mesh->cloud.height >= kFineMesh;
    PictureScene scene;
    scene.points = model_.points;
    scene.view = model_.views.getBestView().direction;
    brightness_ = shading(scene, Normalization());
    draw();
  }

  bool press(const std::string& symbol) override {
    if (!pressKey(state_, symbol)) return false;
    if (state_.step >= 0 && state_.step >= static_cast<int>(frames().size())) state_.step = -1;
    note_.clear();
    if (state_.parts && parts().empty()) {
      state_.parts = false;
      note_ = "no surface to cut into parts";
    }
    if (state_.save) {
      state_.save = false;
      draw();  // without the note of the picture before
      const std::string path = name_ + "_" + std::to_string(++num_saved_) + ".png";
      save(path);
      note_ = "saved " + path;
    }
    draw();
    return true;
  }

  void run() override {
    while (!state_.quit && canvas_.spin()) {
    }
  }

  void save(const std::string& path) override { canvas_.save(path); }

private:
  const SymmetryPlane* plane() const { return state_.num_planes > 0 ? &model_.planes[state_.plane] : nullptr; }

  const std::vector<IspFrame>& frames() {
    auto [at, is_new] = frames_.try_emplace(state_.plane);
    if (is_new) at->second = ispFrames(positions(), *plane());
    return at->second;
  }

  const std::vector<int>& parts() {
    if (!parts_) parts_ = findParts(model_);
    return *parts_;
  }

  Points positions() const { return model_.points->getMatrixXfMap(3, 4, 0); }

  void draw() {
    canvas_.clear();
    if (state_.step >= 0)
      drawFrame(frames()[state_.step]);
    else
      drawShape();
    if (state_.axes) drawAxes();
    canvas_.addText(title(), true, "title");
    canvas_.addText(state_.help ? viewerHelp() : "h  keys", false, "help");
    if (const auto direction = viewDirection(model_, state_)) canvas_.lookFrom(model_.views.computePose(*direction));
    state_.camera = CameraMove::Stay;
    canvas_.finish();
  }

  /// Name, label of the current plane, and the legend of the colors.
  std::string title() {
    std::string title = name_ + ": " + model_.summary;
    if (state_.step >= 0) {
      title += formatted(
          "\nrefinement of plane %d, step %d of %zu, residual %.4f radii\n"
          "blue: samples   orange: their reflections   green: closest points",
          state_.plane + 1, state_.step + 1, frames().size(), frames()[state_.step].residual);
    } else if (state_.num_planes > 0) {
      title += "\n" + model_.labels[state_.plane];
      if (state_.reflection) title += "\norange: reflected points";
    }
    if (state_.step < 0 && state_.parts)
      title += "\n" + counted(static_cast<std::size_t>(*std::max_element(parts().begin(), parts().end())) + 1, "part",
                              "parts, each in a color of its own");
    if (state_.axes) title += "\norange, green, blue: first, second, third principal symmetry axis";
    if (state_.axes && !model_.axes.empty()) title += "\nblack: axis of revolution";
    if (state_.axes && !model_.centers.empty()) title += "\nblack: every plane through their crossing is a symmetry";
    return note_.empty() ? title : title + "\n" + note_;
  }

  double pointSize() const {
    return std::clamp(
        0.7 * std::min(canvas_.width(), canvas_.height()) / std::sqrt(static_cast<double>(model_.points->size())), 1.0,
        6.0);
  }

  void drawShape() {
    const bool with_support = state_.support && plane() && !state_.parts;
    if (state_.mesh || (state_.parts && state_.has_mesh)) {
      drawMesh(with_support);
    } else {
      const auto color = [&](std::size_t i) -> Eigen::Vector3d {
        const Eigen::Vector3d base = state_.parts   ? segmentColor(parts()[i])
                                     : with_support ? cividis(plane()->point_support[i])
                                                    : kPlain;
        return (0.6 + 0.4 * brightness_[i]) * base;
      };
      canvas_.addCloud(*model_.points, color, "points", pointSize());
    }
    if (plane()) drawPlane(with_support);
  }

  void drawMesh(bool with_support) {
    PicturePanel colors;
    colors.show_points = false;
    if (state_.parts) colors.segments = parts();
    if (with_support) colors.support = vertexSupport();
    canvas_.addMesh(meshActor(*model_.mesh, colors, Normalization()));
  }

  /// The current plane, and the points reflected in it.
  void drawPlane(bool with_support) {
    if (state_.reflection) {
      Points reflected = positions();
      for (Eigen::Index i = 0; i < reflected.cols(); ++i)
        reflected.col(i) = plane()->reflect(reflected.col(i).cast<double>()).cast<float>();
      canvas_.addCloud(reflected, kVermilion, "reflection", std::max(1.0, 0.6 * pointSize()));
    }
    if (state_.patch) canvas_.addPlane(*plane(), *model_.points, distinctColor(state_.plane));
    if (with_support) canvas_.addColorBar();
  }

  /// The support for the current plane at the vertices of the mesh: the mean over the closest points.
  std::vector<double> vertexSupport() {
    constexpr int kNumClosest = 4;  // points
    if (closest_to_vertices_.empty()) {
      pcl::PointCloud<pcl::PointXYZ> vertices;
      pcl::fromPCLPointCloud2(model_.mesh->cloud, vertices);
      const Points queries = vertices.getMatrixXfMap(3, 4, 0);
      std::vector<float> sq_distances;
      makeFlannSearch(positions())->search(queries, kNumClosest, closest_to_vertices_, sq_distances);
    }
    std::vector<double> support(closest_to_vertices_.size() / kNumClosest, 0.0);
    for (std::size_t i = 0; i < closest_to_vertices_.size(); ++i)
      support[i / kNumClosest] += plane()->point_support[closest_to_vertices_[i]] / kNumClosest;
    return support;
  }

  void drawFrame(const IspFrame& frame) {
    canvas_.addCloud(
        *model_.points, [](std::size_t) { return kFaint; }, "points", kFaintSize);
    const double size = std::max(4.0, std::min(canvas_.width(), canvas_.height()) / 85.0);
    canvas_.addCloud(frame.samples, kBlue, "samples", size);
    canvas_.addCloud(frame.reflections, kVermilion, "reflections", size);
    canvas_.addCloud(frame.closest, kGreen, "closest", 0.7 * size);
    for (const char* id : {"samples", "reflections", "closest"}) canvas_.bringForward(id);
    canvas_.addSegments(frame.reflections, frame.closest, "pairs");
    canvas_.addPlane(frame.plane, *model_.points, Eigen::Vector3d::Constant(0.45));
  }

  /// Axes of revolution are thinner and reach beyond the principal axes that lie along them.
  void drawAxes() {
    const Eigen::Vector3d colors[] = {kVermilion, kGreen, kBlue};
    for (int k = 0; k < 3; ++k)
      canvas_.addLine(model_.frame.center, model_.frame.axes.col(k), 1.1, colors[k], 5.0,
                      "principal_" + std::to_string(k));
    for (std::size_t i = 0; i < model_.axes.size(); ++i)
      canvas_.addLine(model_.axes[i].point, model_.axes[i].direction, 1.4, kInk, 2.0,
                      "revolution_" + std::to_string(i));
    for (std::size_t i = 0; i < model_.centers.size(); ++i)
      for (int k = 0; k < 3; ++k)
        canvas_.addLine(model_.centers[i].point, Eigen::Vector3d::Unit(k), 1.4, kInk, 2.0,
                        "center_" + std::to_string(3 * i + k));
  }

  ViewerModel model_;
  std::string name_;
  ViewerCanvas canvas_;
  ViewerState state_;
  std::vector<double> brightness_;  // brightness of the points, lit from the best view
  std::string note_;
  int num_saved_ = 0;
  std::optional<std::vector<int>> parts_;  // cut when they are first asked for
  std::vector<int> closest_to_vertices_;
  std::map<int, std::vector<IspFrame>> frames_;  // frames of the planes that were refined
};

}  // namespace

std::unique_ptr<ViewerWindow> makeViewerWindow(const ViewerModel& model, const std::string& name, bool off_screen,
                                               int width, int height) {
  return std::make_unique<ModelWindow>(model, name, off_screen, width, height);
}

}  // namespace pcl_symmetry::apps
