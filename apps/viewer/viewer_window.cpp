#include "viewer/viewer_window.h"

#include <pcl/conversions.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <thread>

#include "io/answers.h"
#include "io/shape_output.h"
#include "pictures/picture_actors.h"

namespace pcl_symmetry::apps {

namespace {

/// Hands keys to the viewer in place of VTK's own; the mouse works as users of VTK and PCL know it.
class KeyStyle : public vtkInteractorStyleTrackballCamera {
public:
  static KeyStyle* New();
  vtkTypeMacro(KeyStyle, vtkInteractorStyleTrackballCamera);
  void OnChar() override {}
  void OnKeyDown() override {
    if (const char* symbol = GetInteractor()->GetKeySym()) on_key(symbol);
  }
  std::function<void(const std::string&)> on_key;
};
vtkStandardNewMacro(KeyStyle);

constexpr double kInFront = -4000.0;  // steps of the depth buffer
constexpr double kViewAngle = 25.0;   // degrees, that of ViewpointSelection's cameras
constexpr float kRoom = 1.2f;         // factor on the distance of the camera
constexpr int kFontSize = 15;         // pixels

// Distinct colors, as numbers of segments; below 0: gray.
constexpr int kFaint = -1, kBlue = 1, kGreen = 2, kVermilion = 4;
const Eigen::Vector3d kInk(0.1, 0.1, 0.1);

/// Points of one color.
/// \param size of a point, pixels.
vtkSmartPointer<vtkActor> plainCloud(const Points& points, int color, double size) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& point : points.colwise()) cloud->emplace_back(point.x(), point.y(), point.z());
  PicturePanel panel;
  panel.segments.assign(cloud->size(), color);
  const std::vector<double> brightness(cloud->size(), 1.0);
  vtkSmartPointer<vtkActor> actor = cloudActor({cloud}, panel, Normalization(), brightness, 1.0);
  actor->GetProperty()->SetPointSize(static_cast<float>(size));
  return actor;
}

/// Lines of text at the left, at the top or at the bottom.
vtkSmartPointer<vtkTextActor> textActor(const std::string& text, bool at_top) {
  vtkSmartPointer<vtkTextActor> actor = labelActor(text, kFontSize);
  actor->SetPosition(0.012, at_top ? 0.985 : 0.015);
  vtkTextProperty* const property = actor->GetTextProperty();
  property->SetJustificationToLeft();
  if (!at_top) property->SetVerticalJustificationToBottom();
  property->SetBackgroundColor(1.0, 1.0, 1.0);
  property->SetBackgroundOpacity(0.8);
  return actor;
}

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

class ModelWindow {
public:
  /// \param off_screen draws, but shows no window and takes no mouse.
  ModelWindow(const ViewerModel& model, const std::string& name, bool off_screen, int width, int height)
      : model_(model), name_(name) {
    window_->SetOffScreenRendering(off_screen);
    window_->SetMultiSamples(0);
    window_->SetAlphaBitPlanes(1);
    window_->SetSize(width, height);
    window_->SetWindowName(name.c_str());
    window_->AddRenderer(renderer_);
    renderer_->SetBackground(1.0, 1.0, 1.0);
    renderer_->SetUseDepthPeeling(true);
    scene_.points = model_.points;
    scene_.view = model_.views.getBestView().direction;
    state_.num_planes = static_cast<int>(model.planes.size());
    state_.has_mesh = model.mesh.has_value();
    // Support on a mesh of few vertices would be lost between them.
    constexpr std::size_t kFineMesh = 2'000;  // vertices
    state_.mesh = state_.has_mesh && model.mesh->cloud.width * model.mesh->cloud.height >= kFineMesh;
    brightness_ = shading(scene_, Normalization());
    draw();
  }

  void press(const std::string& symbol) {
    if (!pressKey(state_, symbol)) return;
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
  }

  /// Until the user quits or closes the window.
  void run() {
    vtkNew<vtkRenderWindowInteractor> interactor;
    interactor->SetRenderWindow(window_);
    vtkNew<KeyStyle> style;
    style->on_key = [this](const std::string& symbol) { press(symbol); };
    interactor->SetInteractorStyle(style);
    interactor->AddObserver(vtkCommand::ExitEvent, this, &ModelWindow::quit);
    interactor->Initialize();
    while (!state_.quit) {
      interactor->ProcessEvents();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  /// Writes what is drawn now as a PNG, whole.
  /// \throws InputError if the file cannot be written.
  void save(const std::string& path) {
    writeAtomically(path, [&](const std::string& temporary) {
      vtkNew<vtkWindowToImageFilter> grab;
      grab->SetInput(window_);
      grab->ReadFrontBufferOff();
      vtkNew<vtkPNGWriter> writer;
      writer->SetInputConnection(grab->GetOutputPort());
      writer->SetFileName(temporary.c_str());
      writer->Write();
      if (writer->GetErrorCode() != 0) throw InputError(path + ": cannot be written");
    });
  }

private:
  void quit() { state_.quit = true; }

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

  /// The shorter edge.
  double pixels() const { return std::min(window_->GetSize()[0], window_->GetSize()[1]); }

  void draw() {
    renderer_->RemoveAllViewProps();
    if (state_.step >= 0)
      drawFrame(frames()[state_.step]);
    else
      drawShape();
    if (state_.axes) drawAxes();
    renderer_->AddActor2D(textActor(title(), true));
    renderer_->AddActor2D(textActor(state_.help ? viewerHelp() : "h  keys", false));
    if (const auto direction = viewDirection(model_, state_)) lookFrom(model_.views.computePose(*direction));
    state_.camera = CameraMove::Stay;
    renderer_->ResetCameraClippingRange();
    window_->Render();
  }

  /// Looks from a pose of ViewpointSelection.
  void lookFrom(const Eigen::Affine3f& pose) {
    const Eigen::Vector3d position = (kRoom * pose.translation()).cast<double>(),
                          forward = pose.linear().col(2).cast<double>(), up = -pose.linear().col(1).cast<double>();
    const Eigen::Vector3d focus = position + position.norm() * forward;
    vtkCamera* const camera = renderer_->GetActiveCamera();
    camera->SetPosition(position.data());
    camera->SetFocalPoint(focus.data());
    camera->SetViewUp(up.data());
    camera->SetViewAngle(kViewAngle);
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

  void drawShape() {
    const bool with_support = state_.support && plane() && !state_.parts;
    PicturePanel panel;
    if (state_.parts) panel.segments = parts();
    if (state_.mesh || (state_.parts && state_.has_mesh)) {
      panel.show_points = false;
      if (with_support) panel.support = vertexSupport();
      renderer_->AddActor(meshActor(*model_.mesh, panel, Normalization()));
    } else {
      if (with_support) panel.support.assign(plane()->point_support.begin(), plane()->point_support.end());
      renderer_->AddActor(cloudActor(scene_, panel, Normalization(), brightness_, pixels()));
    }
    if (plane()) drawPlane(with_support);
  }

  /// The current plane, and the points reflected in it.
  void drawPlane(bool with_support) {
    if (state_.reflection) {
      Points reflected = positions();
      for (auto x : reflected.colwise()) x = plane()->reflect(x.cast<double>()).cast<float>();
      const double size = 0.5 * pixels() / std::sqrt(static_cast<double>(reflected.cols()));
      renderer_->AddActor(plainCloud(reflected, kVermilion, std::clamp(size, 1.0, 4.0)));
    }
    if (state_.patch) addPatch(*plane(), distinctColor(state_.plane));
    if (with_support) renderer_->AddActor2D(colorBar(window_->GetSize()[0], window_->GetSize()[1], kFontSize));
  }

  void addPatch(const ReflectionPlane& plane, const Eigen::Vector3d& color) {
    const PlanePatch patch{plane.normal(), plane.offset(), Eigen::Vector3d::Zero(), 0.0, color};
    addPlane(*renderer_, patch, scene_, Normalization(), 2.0);
  }

  /// \param reach length to either side.
  void addLine(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
               const Eigen::Vector3d& color, double line_width) {
    addAxis(*renderer_, {point, direction, color, reach}, scene_, Normalization(), line_width);
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
    const double size = std::max(4.0, pixels() / 85.0);
    renderer_->AddActor(plainCloud(positions(), kFaint, 2.0));
    const auto addInFront = [&](const Points& points, int color, double point_size) {
      const auto actor = plainCloud(points, color, point_size);
      actor->GetMapper()->SetResolveCoincidentTopologyToPolygonOffset();
      actor->GetMapper()->SetRelativeCoincidentTopologyPointOffsetParameter(kInFront);
      renderer_->AddActor(actor);
    };
    addInFront(frame.samples, kBlue, size);
    addInFront(frame.reflections, kVermilion, size);
    addInFront(frame.closest, kGreen, 0.7 * size);
    for (Eigen::Index i = 0; i < frame.closest.cols(); ++i) {
      const Eigen::Vector3d from = frame.reflections.col(i).cast<double>(), to = frame.closest.col(i).cast<double>();
      if (from != to) addLine(0.5 * (from + to), to - from, 0.5 * (to - from).norm(), kInk, 2.0);
    }
    addPatch(frame.plane, Eigen::Vector3d::Constant(0.45));
  }

  /// Axes of revolution are thinner and reach beyond the principal axes that lie along them.
  void drawAxes() {
    const int colors[] = {kVermilion, kGreen, kBlue};
    for (int k = 0; k < 3; ++k)
      addLine(model_.frame.center, model_.frame.axes.col(k), 1.1, segmentColor(colors[k]), 5.0);
    for (const SymmetryAxis& axis : model_.axes) addLine(axis.point, axis.direction, 1.4, kInk, 2.0);
    for (const SymmetryCenter& center : model_.centers)
      for (int k = 0; k < 3; ++k) addLine(center.point, Eigen::Vector3d::Unit(k), 1.4, kInk, 2.0);
  }

  ViewerModel model_;
  std::string name_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindow> window_;
  PictureScene scene_;  // points and best view of the model
  ViewerState state_;
  std::vector<double> brightness_;  // brightness of the points, lit from the best view
  std::string note_;
  int num_saved_ = 0;
  std::optional<std::vector<int>> parts_;  // cut when they are first asked for
  std::vector<int> closest_to_vertices_;
  std::map<int, std::vector<IspFrame>> frames_;  // frames of the planes that were refined
};

}  // namespace

void showModel(const ViewerModel& model, const std::string& name, const std::vector<std::string>& keys, int width,
               int height, const std::optional<std::string>& screenshot_path) {
  ModelWindow window(model, name, screenshot_path.has_value(), width, height);
  for (const std::string& key : keys) window.press(key);
  if (screenshot_path)
    window.save(*screenshot_path);
  else
    window.run();
}

}  // namespace pcl_symmetry::apps
