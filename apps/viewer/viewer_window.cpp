#include "viewer/viewer_window.h"

#include <pcl/conversions.h>
#include <pcl/visualization/interactor_style.h>
#include <pcl/visualization/pcl_visualizer.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkMapper.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
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
#include <cmath>
#include <functional>
#include <map>

#include "core/base/constants.h"
#include "io/answers.h"
#include "io/shape_output.h"
#include "pictures/patch_geometry.h"
#include "pictures/picture_actors.h"

namespace pcl_symmetry::apps {

namespace {

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

constexpr double kInFront = -4000.0;               // steps of the depth buffer
constexpr double kViewAngle = 25.0 * kPi / 180.0;  // that of ViewpointSelection's cameras
constexpr float kRoom = 1.2f;                      // factor on the distance of the camera
constexpr int kFontSize = 15;                      // pixels
constexpr int kTextMargin = 12;                    // pixels from the left
constexpr double kLine = 0.95;                     // height of a line of text, in font sizes
constexpr int kSpinTime = 20;                      // milliseconds

const Eigen::Vector3d kBlue(0.00, 0.45, 0.70), kVermilion(0.84, 0.37, 0.00), kGreen(0.00, 0.62, 0.45),
    kPlain(0.40, 0.47, 0.60), kFaint(0.78, 0.78, 0.80), kInk(0.1, 0.1, 0.1);

using ColorOf = std::function<Eigen::Vector3d(std::size_t)>;

pcl::PointCloud<pcl::PointXYZRGB>::Ptr colored(const pcl::PointCloud<pcl::PointXYZ>& points, const ColorOf& color) {
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

/// What the viewer draws with: clouds, planes, lines and texts in PCL's visualizer, its camera, and its pictures.
class ViewerCanvas {
public:
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;

  /// \param off_screen draws, but shows no window and takes no mouse.
  /// \param width,height pixels.
  /// \param on_key called with the name of each key that is pressed.
  ViewerCanvas(const std::string& title, bool off_screen, int width, int height,
               const std::function<void(const std::string&)>& on_key)
      : off_screen_(off_screen), width_(width), height_(height), style_(vtkSmartPointer<KeyStyle>::New()) {
    window_->SetOffScreenRendering(off_screen);
    window_->SetMultiSamples(0);
    window_->SetSize(width, height);
    int argc = 0;
    viewer_.reset(new pcl::visualization::PCLVisualizer(argc, nullptr, renderer_, window_, title, style_, !off_screen));
    viewer_->setBackgroundColor(1.0, 1.0, 1.0);
    viewer_->setShowFPS(false);
    viewer_->setSize(width, height);
    viewer_->setCameraFieldOfView(kViewAngle);
    style_->on_key = on_key;
  }

  /// Removes all that was added.
  void clear() {
    viewer_->removeAllPointClouds();
    viewer_->removeAllShapes();
    if (bar_) renderer_->RemoveActor2D(bar_);
    if (mesh_) renderer_->RemoveActor(mesh_);
    bar_ = nullptr;
    mesh_ = nullptr;
  }

  /// Draws now where no window would do so.
  void finish() {
    renderer_->ResetCameraClippingRange();
    if (off_screen_) window_->Render();
  }

  /// \param size of a point, pixels.
  void addCloud(const Cloud& points, const ColorOf& color, const std::string& id, double size) {
    viewer_->addPointCloud(colored(points, color), id);
    viewer_->setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, size, id);
  }

  void addCloud(const Points& points, const Eigen::Vector3d& color, const std::string& id, double size) {
    addCloud(
        toCloud(points), [&](std::size_t) { return color; }, id, size);
  }

  /// Draws an added cloud in front of the points around it.
  void bringForward(const std::string& id) {
    vtkMapper* mapper = (*viewer_->getCloudActorMap())[id].actor->GetMapper();
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    mapper->SetRelativeCoincidentTopologyPointOffsetParameter(kInFront);
  }

  /// One segment for each pair of columns.
  void addSegments(const Points& from, const Points& to, const std::string& id) {
    viewer_->addModelFromPolyData(segments(from, to), id);
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_COLOR, 0.1, 0.1, 0.1, id);
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, 2.0, id);
  }

  void addMesh(const vtkSmartPointer<vtkActor>& mesh) {
    mesh_ = mesh;
    renderer_->AddActor(mesh_);
  }

  /// A translucent rectangle around the projections of the points.
  void addPlane(const ReflectionPlane& plane, const Cloud& points, const Eigen::Vector3d& color) {
    PlanePatch patch;
    patch.normal = plane.normal();
    patch.offset = plane.offset();
    pcl::PointCloud<pcl::PointXYZ>::Ptr corners(new pcl::PointCloud<pcl::PointXYZ>);
    for (const Eigen::Vector3d& corner : fittedCorners(patch, points)) {
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

  /// \param reach length to either side.
  void addLine(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
               const Eigen::Vector3d& color, double line_width, const std::string& id) {
    const Eigen::Vector3f a = (point - reach * direction).cast<float>(), b = (point + reach * direction).cast<float>();
    viewer_->addLine(pcl::PointXYZ(a.x(), a.y(), a.z()), pcl::PointXYZ(b.x(), b.y(), b.z()), color.x(), color.y(),
                     color.z(), id);
    viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, line_width, id);
  }

  /// The scale of the support.
  void addColorBar() {
    bar_ = colorBar(width_, height_, kFontSize);
    renderer_->AddActor2D(bar_);
  }

  /// Lines of text at the left, at the top or at the bottom.
  void addText(const std::string& text, bool at_top, const std::string& id) {
    // PCL places texts by their lower edge: those at the top go down by their lines.
    const auto num_lines = 1 + std::count(text.begin(), text.end(), '\n');
    const int bottom = at_top ? height_ - 7 - static_cast<int>(kLine * kFontSize * static_cast<double>(num_lines)) : 12;
    const Eigen::Vector3d& ink = kInk;
    viewer_->addText(text, kTextMargin, bottom, kFontSize, ink.x(), ink.y(), ink.z(), id);
    vtkTextProperty* property = vtkTextActor::SafeDownCast(viewer_->getShapeActorMap()->at(id))->GetTextProperty();
    property->SetBackgroundColor(1.0, 1.0, 1.0);
    property->SetBackgroundOpacity(0.8);
  }

  /// Looks from a pose of ViewpointSelection.
  void lookFrom(const Eigen::Affine3f& pose) {
    const Eigen::Vector3f position = kRoom * pose.translation(), forward = pose.linear().col(2),
                          up = -pose.linear().col(1);
    const Eigen::Vector3f focus = position + position.norm() * forward;
    viewer_->setCameraPosition(position.x(), position.y(), position.z(), focus.x(), focus.y(), focus.z(), up.x(),
                               up.y(), up.z());
    viewer_->setCameraFieldOfView(kViewAngle);
  }

  /// Writes what is drawn now as a PNG, whole.
  /// \throws InputError if the file cannot be written.
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

  /// Handles what the user does for a moment.
  /// \return false once the window is closed.
  bool spin() {
    if (viewer_->wasStopped()) return false;
    viewer_->spinOnce(kSpinTime, true);
    return true;
  }

  int width() const { return width_; }
  int height() const { return height_; }

private:
  bool off_screen_;
  int width_, height_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindow> window_;
  vtkSmartPointer<KeyStyle> style_;
  vtkSmartPointer<vtkScalarBarActor> bar_;
  vtkSmartPointer<vtkActor> mesh_;
  pcl::visualization::PCLVisualizer::Ptr viewer_;
};

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

class ModelWindow {
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

  void run() {
    while (!state_.quit && canvas_.spin()) {
    }
  }

  void save(const std::string& path) { canvas_.save(path); }

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
