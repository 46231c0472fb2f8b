#include "viewer/viewer_window.h"

#include <pcl/conversions.h>
#include <pcl/visualization/interactor_style.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <vtkCellArray.h>
#include <vtkMapper.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRendererCollection.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "common/pictures/picture_actors.h"
#include "common/shape_output/shape_output.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "viewer/isp_frames.h"
#include "core/base/constants.h"

namespace pcl_symmetry::apps {

namespace {

const Eigen::Vector3d kBlue(0.00, 0.45, 0.70), kVermilion(0.84, 0.37, 0.00), kGreen(0.00, 0.62, 0.45),
    kPlain(0.40, 0.47, 0.60), kFaint(0.78, 0.78, 0.80), kInk(0.1, 0.1, 0.1);
constexpr double kViewAngle = 25.0 * kPi / 180.0;  // derived: that of ViewpointSelection's cameras
constexpr float kRoom = 1.2f;  // of the camera's distance; chosen: planes that reach beyond the shape are seen whole
constexpr double kFaintSize = 2.0;    // pixels; chosen: twice covers the samples, half is invisible
constexpr double kInFront = -4000.0;  // steps of the depth buffer; chosen: markers stay in front of the points
constexpr int kFontSize = 15;         // pixels; chosen: half cannot be read, twice covers the shape

/// Hands keys to the viewer in place of PCL's own; the mouse works as PCL users know it.
class KeyStyle : public pcl::visualization::PCLVisualizerInteractorStyle {
public:
  static KeyStyle* New();
  vtkTypeMacro(KeyStyle, pcl::visualization::PCLVisualizerInteractorStyle);
  void OnChar() override {}
  void OnKeyUp() override {}
  void OnKeyDown() override {
    const char* symbol = Interactor ? Interactor->GetKeySym() : nullptr;
    if (symbol && on_key) on_key(symbol);
  }
  std::function<void(const std::string&)> on_key;
};
vtkStandardNewMacro(KeyStyle);

pcl::PointCloud<pcl::PointXYZRGB>::Ptr colored(const pcl::PointCloud<pcl::PointXYZ>& points,
                                               const std::function<Eigen::Vector3d(std::size_t)>& color) {
  pcl::PointCloud<pcl::PointXYZRGB>::Ptr result(new pcl::PointCloud<pcl::PointXYZRGB>);
  result->reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto rgb = (255.0 * color(i)).cast<std::uint8_t>().eval();
    pcl::PointXYZRGB point(rgb[0], rgb[1], rgb[2]);
    point.getVector3fMap() = points[i].getVector3fMap();
    result->push_back(point);
  }
  return result;
}

pcl::PointCloud<pcl::PointXYZ> toCloud(const Points& points) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (Eigen::Index i = 0; i < points.cols(); ++i) cloud.emplace_back(points(0, i), points(1, i), points(2, i));
  return cloud;
}

/// One segment for each column.
vtkSmartPointer<vtkPolyData> segments(const Points& from, const Points& to) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  for (Eigen::Index i = 0; i < from.cols(); ++i) {
    const vtkIdType ends[] = {points->InsertNextPoint(from.col(i).data()), points->InsertNextPoint(to.col(i).data())};
    lines->InsertNextCell(2, ends);
  }
  vtkSmartPointer<vtkPolyData> data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(lines);
  return data;
}

}  // namespace

class ViewerWindow::Implementation {
public:
  Implementation(const ViewerModel& model, const std::string& name, bool off_screen, int width, int height)
      : model_(model), name_(name), off_screen_(off_screen), width_(width), height_(height) {
    state_.num_planes = static_cast<int>(model.planes.size());
    state_.has_mesh = model.mesh.has_value();
    // Support on a mesh of few vertices would be lost between them.
    constexpr std::size_t kFineMesh = 2'000;  // vertices; chosen: half shows gradients between far vertices
    state_.mesh = state_.has_mesh && model.mesh->cloud.width * model.mesh->cloud.height >= kFineMesh;
    window_->SetOffScreenRendering(off_screen);
    window_->SetMultiSamples(0);
    window_->SetSize(width, height);
    PictureScene scene;
    scene.points = model_.points;
    scene.view = model_.views.getBestView().direction;
    brightness_ = shading(scene, Normalization());
    int argc = 0;
    viewer_.reset(new pcl::visualization::PCLVisualizer(argc, nullptr, renderer_, window_, name, style_, !off_screen));
    viewer_->setBackgroundColor(1.0, 1.0, 1.0);
    viewer_->setShowFPS(false);
    viewer_->setSize(width, height);
    viewer_->setCameraFieldOfView(kViewAngle);
    style_->on_key = [this](const std::string& symbol) { press(symbol); };
    draw();
  }

  const ViewerState& state() const { return state_; }

  bool press(const std::string& symbol) {
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

  void run() {
    while (!viewer_->wasStopped() && !state_.quit) viewer_->spinOnce(20, true);
  }

  void save(const std::string& path) {
    window_->Render();
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

  Points positions() const {
    Points result(3, model_.points->size());
    for (std::size_t i = 0; i < model_.points->size(); ++i) result.col(i) = (*model_.points)[i].getVector3fMap();
    return result;
  }

  void draw() {
    viewer_->removeAllPointClouds();
    viewer_->removeAllShapes();
    if (bar_) renderer_->RemoveActor2D(bar_);
    if (mesh_) renderer_->RemoveActor(mesh_);
    bar_ = nullptr;
    mesh_ = nullptr;
    if (state_.step >= 0) {
      drawFrame(frames()[state_.step]);
    } else {
      drawShape();
    }
    if (state_.axes) drawAxes();
    drawTexts();
    moveCamera();
    renderer_->ResetCameraClippingRange();
    if (off_screen_) window_->Render();
  }

  void addCloud(const pcl::PointCloud<pcl::PointXYZRGB>::Ptr& cloud, const std::string& id, double size) {
    viewer_->addPointCloud(cloud, id);
    viewer_->setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, size, id);
  }

  void addCloud(const Points& points, const std::string& id, const Eigen::Vector3d& color, double size) {
    addCloud(colored(toCloud(points), [&](std::size_t) { return color; }), id, size);
  }

  double pointSize() const {
    return std::clamp(0.7 * std::min(width_, height_) / std::sqrt(static_cast<double>(model_.points->size())), 1.0,
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
      addCloud(colored(*model_.points, color), "points", pointSize());
    }
    if (plane()) drawPlane(with_support);
  }

  void drawMesh(bool with_support) {
    PicturePanel colors;
    colors.show_points = false;
    if (state_.parts) colors.segments = parts();
    if (with_support) colors.support = vertexSupport();
    mesh_ = meshActor(*model_.mesh, colors, Normalization());
    renderer_->AddActor(mesh_);
  }

  /// The current plane, and the points reflected in it.
  void drawPlane(bool with_support) {
    if (state_.reflection) {
      Points reflected = positions();
      for (Eigen::Index i = 0; i < reflected.cols(); ++i)
        reflected.col(i) = plane()->reflect(reflected.col(i).cast<double>()).cast<float>();
      addCloud(reflected, "reflection", kVermilion, std::max(1.0, 0.6 * pointSize()));
    }
    if (state_.patch) addPlane(*plane(), distinctColor(state_.plane));
    if (with_support) {
      bar_ = colorBar(width_, height_, kFontSize);
      renderer_->AddActor2D(bar_);
    }
  }

  /// Of the current plane, at the vertices of the mesh: the mean over the closest points.
  std::vector<double> vertexSupport() {
    constexpr int kNumClosest = 4;  // points; chosen: half is noisy, twice blurs
    if (closest_to_vertices_.empty()) {
      pcl::PointCloud<pcl::PointXYZ> vertices;
      pcl::fromPCLPointCloud2(model_.mesh->cloud, vertices);
      Points queries(3, vertices.size());
      for (std::size_t i = 0; i < vertices.size(); ++i) queries.col(i) = vertices[i].getVector3fMap();
      std::vector<float> sq_distances;
      makeFlannSearch(positions())->search(queries, kNumClosest, closest_to_vertices_, sq_distances);
    }
    std::vector<double> support(closest_to_vertices_.size() / kNumClosest, 0.0);
    for (std::size_t i = 0; i < closest_to_vertices_.size(); ++i)
      support[i / kNumClosest] += plane()->point_support[closest_to_vertices_[i]] / kNumClosest;
    return support;
  }

  void drawFrame(const IspFrame& frame) {
    addCloud(colored(*model_.points, [](std::size_t) { return kFaint; }), "points", kFaintSize);
    const double size = std::max(4.0, std::min(width_, height_) / 85.0);
    addCloud(frame.samples, "samples", kBlue, size);
    addCloud(frame.reflections, "reflections", kVermilion, size);
    addCloud(frame.closest, "closest", kGreen, 0.7 * size);
    // Markers in front of the points around them.
    for (const char* id : {"samples", "reflections", "closest"}) {
      vtkMapper* mapper = (*viewer_->getCloudActorMap())[id].actor->GetMapper();
      mapper->SetResolveCoincidentTopologyToPolygonOffset();
      mapper->SetRelativeCoincidentTopologyPointOffsetParameter(kInFront);
    }
    viewer_->addModelFromPolyData(segments(frame.reflections, frame.closest), "pairs");
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_COLOR, 0.1, 0.1, 0.1, "pairs");
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, 2.0, "pairs");
    addPlane(frame.plane, Eigen::Vector3d::Constant(0.45));
  }

  void addPlane(const ReflectionPlane& plane, const Eigen::Vector3d& color) {
    PlanePatch patch;
    patch.normal = plane.normal();
    patch.offset = plane.offset();
    pcl::PointCloud<pcl::PointXYZ>::Ptr corners(new pcl::PointCloud<pcl::PointXYZ>);
    for (const Eigen::Vector3d& corner : fittedCorners(patch, *model_.points)) {
      const Eigen::Vector3f c = corner.cast<float>();
      corners->emplace_back(c.x(), c.y(), c.z());
    }
    using namespace pcl::visualization;
    for (const bool filled : {true, false}) {
      const std::string id = filled ? "plane" : "outline";
      viewer_->addPolygon<pcl::PointXYZ>(corners, color.x(), color.y(), color.z(), id);
      viewer_->setShapeRenderingProperties(
          PCL_VISUALIZER_REPRESENTATION,
          filled ? PCL_VISUALIZER_REPRESENTATION_SURFACE : PCL_VISUALIZER_REPRESENTATION_WIREFRAME, id);
      viewer_->setShapeRenderingProperties(PCL_VISUALIZER_OPACITY, filled ? 0.3 : 1.0, id);
      viewer_->setShapeRenderingProperties(PCL_VISUALIZER_LINE_WIDTH, 2.0, id);
      vtkActor::SafeDownCast(viewer_->getShapeActorMap()->at(id))->GetProperty()->LightingOff();
    }
  }

  /// \param reach length to either side. \param width pixels.
  void addLine(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
               const Eigen::Vector3d& color, double width, const std::string& id) {
    const Eigen::Vector3f a = (point - reach * direction).cast<float>(), b = (point + reach * direction).cast<float>();
    viewer_->addLine(pcl::PointXYZ(a.x(), a.y(), a.z()), pcl::PointXYZ(b.x(), b.y(), b.z()), color.x(), color.y(),
                     color.z(), id);
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, width, id);
  }

  /// Axes of revolution are thinner and reach beyond the principal axes that lie along them.
  void drawAxes() {
    const Eigen::Vector3d colors[] = {kVermilion, kGreen, kBlue};
    for (int k = 0; k < 3; ++k)
      addLine(model_.frame.center, model_.frame.axes.col(k), 1.1, colors[k], 5.0, "principal_" + std::to_string(k));
    for (std::size_t i = 0; i < model_.axes.size(); ++i)
      addLine(model_.axes[i].point, model_.axes[i].direction, 1.4, kInk, 2.0, "revolution_" + std::to_string(i));
    for (std::size_t i = 0; i < model_.centers.size(); ++i)
      for (int k = 0; k < 3; ++k)
        addLine(model_.centers[i].point, Eigen::Vector3d::Unit(k), 1.4, kInk, 2.0,
                "center_" + std::to_string(3 * i + k));
  }

  void drawTexts() {
    std::string title = name_ + ": " + model_.summary;
    if (state_.step >= 0) {
      const IspFrame& frame = frames()[state_.step];
      char text[200];
      std::snprintf(text, sizeof(text),
                    "refinement of plane %d, step %d of %zu, residual %.4f radii\n"
                    "blue: samples   orange: their reflections   green: closest points",
                    state_.plane + 1, state_.step + 1, frames().size(), frame.residual);
      title += std::string("\n") + text;
    } else if (plane()) {
      title += "\n" + model_.labels[state_.plane];
      if (state_.reflection) title += "\norange: reflected points";
    }
    if (state_.step < 0 && state_.parts) {
      const int num_parts = *std::max_element(parts().begin(), parts().end()) + 1;
      title += "\n" + std::to_string(num_parts) + (num_parts == 1 ? " part" : " parts, each in a colour of its own");
    }
    if (state_.axes) title += "\norange, green, blue: first, second, third principal symmetry axis";
    if (state_.axes && !model_.axes.empty()) title += "\nblack: axis of revolution";
    if (state_.axes && !model_.centers.empty()) title += "\nblack: every plane through their crossing is a symmetry";
    if (!note_.empty()) title += "\n" + note_;
    addText(title, height_ - 1, true, "title");
    addText(state_.help ? viewerHelp() : "h  keys", 12, false, "help");
  }

  /// PCL places texts by their lower edge: those at the top go down by their lines.
  void addText(const std::string& text, int y, bool from_top, const std::string& id) {
    const auto num_lines = 1 + std::count(text.begin(), text.end(), '\n');
    const int bottom = from_top ? y - 6 - static_cast<int>(0.95 * kFontSize * static_cast<double>(num_lines)) : y;
    viewer_->addText(text, 12, bottom, kFontSize, kInk.x(), kInk.y(), kInk.z(), id);
    vtkTextProperty* property = vtkTextActor::SafeDownCast(viewer_->getShapeActorMap()->at(id))->GetTextProperty();
    property->SetBackgroundColor(1.0, 1.0, 1.0);
    property->SetBackgroundOpacity(0.8);
  }

  void moveCamera() {
    Eigen::Vector3d direction;
    switch (state_.camera) {
      case CameraMove::Stay:
        return;
      case CameraMove::Best:
        direction = model_.views.getBestView().direction;
        break;
      case CameraMove::Worst:
        direction = model_.views.getWorstView().direction;
        break;
      case CameraMove::Along: {
        const Eigen::Vector3d n = plane() ? plane()->normal() : Eigen::Vector3d::UnitX();
        const Eigen::Vector3d up = model_.views.getUpAxis();
        const Eigen::Vector3d along = n.cross(up);
        direction = along.norm() > 0.2 ? along.normalized() : n.unitOrthogonal();
        break;
      }
    }
    state_.camera = CameraMove::Stay;
    const Eigen::Affine3f pose = model_.views.computePose(direction);
    const Eigen::Vector3f position = kRoom * pose.translation(), forward = pose.linear().col(2),
                          up = -pose.linear().col(1);
    const Eigen::Vector3f focus = position + position.norm() * forward;
    viewer_->setCameraPosition(position.x(), position.y(), position.z(), focus.x(), focus.y(), focus.z(), up.x(),
                               up.y(), up.z());
    viewer_->setCameraFieldOfView(kViewAngle);
  }

  ViewerModel model_;
  std::string name_;
  bool off_screen_;
  int width_, height_;
  ViewerState state_;
  std::vector<double> brightness_;  // of the points, lit from the best view
  std::string note_;
  int num_saved_ = 0;
  std::optional<std::vector<int>> parts_;  // cut when they are first asked for
  std::vector<int> closest_to_vertices_;
  std::map<int, std::vector<IspFrame>> frames_;  // of the planes that were refined
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<KeyStyle> style_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  vtkSmartPointer<vtkActor> mesh_;
  pcl::visualization::PCLVisualizer::Ptr viewer_;
};

ViewerWindow::ViewerWindow(const ViewerModel& model, const std::string& name, bool off_screen, int width, int height)
    : implementation_(new Implementation(model, name, off_screen, width, height)) {}

ViewerWindow::~ViewerWindow() = default;

const ViewerState& ViewerWindow::state() const {
  return implementation_->state();
}

bool ViewerWindow::press(const std::string& symbol) {
  return implementation_->press(symbol);
}

void ViewerWindow::run() {
  implementation_->run();
}

void ViewerWindow::save(const std::string& path) {
  implementation_->save(path);
}

}  // namespace pcl_symmetry::apps
