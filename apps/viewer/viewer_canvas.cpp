#include "viewer/viewer_canvas.h"

#include <pcl/visualization/interactor_style.h>
#include <vtkCellArray.h>
#include <vtkMapper.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>

#include "core/base/constants.h"
#include "io/shape_output.h"
#include "pictures/patch_geometry.h"
#include "pictures/picture_actors.h"

namespace pcl_symmetry::apps {

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

namespace {

constexpr double kInFront = -4000.0;               // steps of the depth buffer
constexpr double kViewAngle = 25.0 * kPi / 180.0;  // that of ViewpointSelection's cameras
constexpr float kRoom = 1.2f;                      // factor on the distance of the camera
constexpr int kFontSize = 15;                      // pixels
constexpr int kTextMargin = 12;                    // pixels from the left
constexpr double kLine = 0.95;                     // height of a line of text, in font sizes
constexpr int kSpinTime = 20;                      // milliseconds

pcl::PointCloud<pcl::PointXYZRGB>::Ptr colored(const ViewerCanvas::Cloud& points, const ViewerCanvas::ColorOf& color) {
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

ViewerCanvas::ViewerCanvas(const std::string& title, bool off_screen, int width, int height,
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

ViewerCanvas::~ViewerCanvas() = default;

void ViewerCanvas::clear() {
  viewer_->removeAllPointClouds();
  viewer_->removeAllShapes();
  if (bar_) renderer_->RemoveActor2D(bar_);
  if (mesh_) renderer_->RemoveActor(mesh_);
  bar_ = nullptr;
  mesh_ = nullptr;
}

void ViewerCanvas::finish() {
  renderer_->ResetCameraClippingRange();
  if (off_screen_) window_->Render();
}

void ViewerCanvas::addCloud(const Cloud& points, const ColorOf& color, const std::string& id, double size) {
  viewer_->addPointCloud(colored(points, color), id);
  viewer_->setPointCloudRenderingProperties(pcl::visualization::PCL_VISUALIZER_POINT_SIZE, size, id);
}

void ViewerCanvas::addCloud(const Points& points, const Eigen::Vector3d& color, const std::string& id, double size) {
  addCloud(
      toCloud(points), [&](std::size_t) { return color; }, id, size);
}

void ViewerCanvas::bringForward(const std::string& id) {
  vtkMapper* mapper = (*viewer_->getCloudActorMap())[id].actor->GetMapper();
  mapper->SetResolveCoincidentTopologyToPolygonOffset();
  mapper->SetRelativeCoincidentTopologyPointOffsetParameter(kInFront);
}

void ViewerCanvas::addSegments(const Points& from, const Points& to, const std::string& id) {
  viewer_->addModelFromPolyData(segments(from, to), id);
  viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_COLOR, 0.1, 0.1, 0.1, id);
  viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, 2.0, id);
}

void ViewerCanvas::addMesh(const vtkSmartPointer<vtkActor>& mesh) {
  mesh_ = mesh;
  renderer_->AddActor(mesh_);
}

void ViewerCanvas::addPlane(const ReflectionPlane& plane, const Cloud& points, const Eigen::Vector3d& color) {
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

void ViewerCanvas::addLine(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
                           const Eigen::Vector3d& color, double line_width, const std::string& id) {
  const Eigen::Vector3f a = (point - reach * direction).cast<float>(), b = (point + reach * direction).cast<float>();
  viewer_->addLine(pcl::PointXYZ(a.x(), a.y(), a.z()), pcl::PointXYZ(b.x(), b.y(), b.z()), color.x(), color.y(),
                   color.z(), id);
  viewer_->setShapeRenderingProperties(pcl::visualization::PCL_VISUALIZER_LINE_WIDTH, line_width, id);
}

void ViewerCanvas::addColorBar() {
  bar_ = colorBar(width_, height_, kFontSize);
  renderer_->AddActor2D(bar_);
}

void ViewerCanvas::addText(const std::string& text, bool at_top, const std::string& id) {
  // PCL places texts by their lower edge: those at the top go down by their lines.
  const auto num_lines = 1 + std::count(text.begin(), text.end(), '\n');
  const int bottom = at_top ? height_ - 7 - static_cast<int>(kLine * kFontSize * static_cast<double>(num_lines)) : 12;
  const Eigen::Vector3d& ink = viewer_colors::kInk;
  viewer_->addText(text, kTextMargin, bottom, kFontSize, ink.x(), ink.y(), ink.z(), id);
  vtkTextProperty* property = vtkTextActor::SafeDownCast(viewer_->getShapeActorMap()->at(id))->GetTextProperty();
  property->SetBackgroundColor(1.0, 1.0, 1.0);
  property->SetBackgroundOpacity(0.8);
}

void ViewerCanvas::lookFrom(const Eigen::Affine3f& pose) {
  const Eigen::Vector3f position = kRoom * pose.translation(), forward = pose.linear().col(2),
                        up = -pose.linear().col(1);
  const Eigen::Vector3f focus = position + position.norm() * forward;
  viewer_->setCameraPosition(position.x(), position.y(), position.z(), focus.x(), focus.y(), focus.z(), up.x(), up.y(),
                             up.z());
  viewer_->setCameraFieldOfView(kViewAngle);
}

void ViewerCanvas::save(const std::string& path) {
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

bool ViewerCanvas::spin() {
  if (viewer_->wasStopped()) return false;
  viewer_->spinOnce(kSpinTime, true);
  return true;
}

}  // namespace pcl_symmetry::apps
