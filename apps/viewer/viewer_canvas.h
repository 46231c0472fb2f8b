/// What the viewer draws with: clouds, planes, lines and texts in PCL's visualizer, its camera, and its pictures.
#pragma once

#include <pcl/visualization/pcl_visualizer.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>

#include <Eigen/Geometry>
#include <functional>
#include <string>

#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/core/reflection_plane.h"

namespace pcl_symmetry::apps {

class KeyStyle;

/// Colors that the legend names.
namespace viewer_colors {
const Eigen::Vector3d kBlue(0.00, 0.45, 0.70), kVermilion(0.84, 0.37, 0.00), kGreen(0.00, 0.62, 0.45),
    kPlain(0.40, 0.47, 0.60), kFaint(0.78, 0.78, 0.80), kInk(0.1, 0.1, 0.1);
}  // namespace viewer_colors

class ViewerCanvas {
public:
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  using ColorOf = std::function<Eigen::Vector3d(std::size_t)>;

  /// \param off_screen draws, but shows no window and takes no mouse
  /// \param width,height pixels
  /// \param on_key called with the name of each key that is pressed
  ViewerCanvas(const std::string& title, bool off_screen, int width, int height,
               const std::function<void(const std::string&)>& on_key);
  ~ViewerCanvas();

  int width() const { return width_; }
  int height() const { return height_; }

  /// Removes all that was added.
  void clear();
  /// Draws now where no window would do so.
  void finish();

  /// \param size of a point, pixels
  void addCloud(const Cloud& points, const ColorOf& color, const std::string& id, double size);
  void addCloud(const Points& points, const Eigen::Vector3d& color, const std::string& id, double size);
  /// Draws an added cloud in front of the points around it.
  void bringForward(const std::string& id);
  /// One segment for each pair of columns.
  void addSegments(const Points& from, const Points& to, const std::string& id);
  void addMesh(const vtkSmartPointer<vtkActor>& mesh);
  /// A translucent rectangle around the projections of the points.
  void addPlane(const ReflectionPlane& plane, const Cloud& points, const Eigen::Vector3d& color);
  /// \param reach length to either side
  /// \param line_width pixels
  void addLine(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double reach,
               const Eigen::Vector3d& color, double line_width, const std::string& id);
  /// The scale of the support.
  void addColorBar();
  /// Lines of text at the left, at the top or at the bottom.
  void addText(const std::string& text, bool at_top, const std::string& id);

  /// Looks from a pose of ViewpointSelection.
  void lookFrom(const Eigen::Affine3f& pose);

  /// Writes what is drawn now as a PNG, whole.
  /// \throws InputError if the file cannot be written
  void save(const std::string& path);

  /// Handles what the user does for a moment.
  /// \return false once the window is closed
  bool spin();

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

}  // namespace pcl_symmetry::apps
