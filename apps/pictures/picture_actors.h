/// VTK actors of a scene: points, mesh, planes, axes, and their legends.
#pragma once

#include <vtkActor.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <string>
#include <vector>

#include "pictures/patch_geometry.h"
#include "pictures/picture.h"

namespace pcl_symmetry::apps {

/// \return brightness of each point with a light at the camera, in [0, 1].
std::vector<double> shading(const PictureScene& scene, const Normalization& normalize);

/// \param brightness of each point.
/// \param panel_pixels the shorter edge of the panel, pixels.
vtkSmartPointer<vtkActor> cloudActor(const PictureScene& scene, const PicturePanel& panel,
                                     const Normalization& normalize, const std::vector<double>& brightness,
                                     double panel_pixels);

/// The mesh in light gray; in the colors of PicturePanel::segments of its polygons, or of the panel's support if the
/// panel shows no points and has one value per vertex.
vtkSmartPointer<vtkActor> meshActor(const pcl::PolygonMesh& mesh, const PicturePanel& panel,
                                    const Normalization& normalize);

/// The axis extends a tenth beyond the points, unless it has a length of its own.
/// \param line_width pixels.
void addAxis(vtkRenderer& renderer, const AxisLine& axis, const PictureScene& scene, const Normalization& normalize,
             double line_width);

/// The patch with its outline.
/// \param line_width pixels.
void addPlane(vtkRenderer& renderer, const PlanePatch& plane, const PictureScene& scene, const Normalization& normalize,
              double line_width);

/// \param font_size pixels.
vtkSmartPointer<vtkTextActor> labelActor(const std::string& text, int font_size);

/// Names of the panel's segments on their colors, in the lower left corner.
/// \param panel_height,font_size pixels.
void addLegend(vtkRenderer& renderer, const PicturePanel& panel, int panel_height, int font_size);

/// The color bar of the support.
/// \param panel_width,panel_height,font_size pixels.
vtkSmartPointer<vtkScalarBarActor> colorBar(int panel_width, int panel_height, int font_size);

}  // namespace pcl_symmetry::apps
