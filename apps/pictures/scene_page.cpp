#include "pictures/scene_page.h"

#include <pcl/conversions.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/beast/core/detail/base64.hpp>
#include <cmath>
#include <set>

#include "io/answers.h"
#include "io/shape_input.h"
#include "io/shape_output.h"
#include "pictures/patch_geometry.h"

namespace pcl_symmetry::apps {

// The parts of a page that are the same for all shapes; made from page.html, three.min.js and viewer.js by CMake.
extern const char* const kPageHead;     ///< HTML up to the first script
extern const char* const kPageLibrary;  ///< three.js with its license
extern const char* const kPageViewer;   ///< JavaScript

namespace {

constexpr std::size_t kMaxPagePoints = 200'000;  // greatest number of points of a page
constexpr int kBarColors = 12;                   // the anchors of the color scale
// Greatest number of segments of a panel whose colors are shown before its name.
constexpr std::size_t kMostSwatches = 8;

template <typename Value>
std::string base64(const std::vector<Value>& values) {
  namespace detail = boost::beast::detail::base64;
  const std::size_t size = values.size() * sizeof(Value);
  std::string text(detail::encoded_size(size), '\0');
  text.resize(detail::encode(text.data(), values.data(), size));
  return text;
}

template <typename Vector>
nlohmann::json numbers(const Vector& v) {
  return {v[0], v[1], v[2]};
}

void addColor(const Eigen::Vector3d& color, std::vector<std::uint8_t>& bytes) {
  for (const std::uint8_t byte : bytesOf(color)) bytes.push_back(byte);
}

/// The content of a page: the finite points of a scene (all, or every second, third, ...) and its mesh in triangles.
class PageScene {
public:
  explicit PageScene(const PictureScene& scene) : scene_(scene), normalize_(normalizationOf(scene)) {
    std::vector<std::size_t> finite;
    finitePoints(*scene.points, &finite);
    const std::size_t step = (finite.size() + kMaxPagePoints - 1) / kMaxPagePoints;
    for (std::size_t i = 0; i < finite.size(); i += step) kept_.push_back(finite[i]);
    if (scene.mesh) cutIntoTriangles(*scene.mesh);
  }

  nlohmann::json json(const PageText& text) const {
    nlohmann::json page{{"title", text.title},
                        {"text", text.text},
                        {"view", numbers(scene_.view)},
                        {"up", numbers(scene_.up)},
                        {"plain_point", numbers(bytesOf(kPlainPointColor))},
                        {"plain_mesh", numbers(bytesOf(kPlainMeshColor))},
                        {"point_size", 0.5 / std::sqrt(static_cast<double>(std::max<std::size_t>(1, kept_.size())))},
                        {"points", positions()},
                        {"normals", normals()},
                        {"mesh", triangles_.empty() ? "" : base64(triangles_)},
                        {"panels", nlohmann::json::array()},
                        {"support_colors", nlohmann::json::array()}};
    if (text.picture.width > 0)
      page["picture"] = {{"width", text.picture.width}, {"pixels", base64(text.picture.pixels)}};
    for (const PicturePanel& panel : scene_.panels) page["panels"].push_back(panelJson(panel));
    for (int i = 0; i < kBarColors; ++i) {
      const auto c = bytesOf(cividis(i / (kBarColors - 1.0)));
      page["support_colors"].push_back(formatted("rgb(%d,%d,%d)", c[0], c[1], c[2]));
    }
    return page;
  }

private:
  void cutIntoTriangles(const pcl::PolygonMesh& mesh) {
    Cloud vertices;
    pcl::fromPCLPointCloud2(mesh.cloud, vertices);
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
      const auto& corners = mesh.polygons[f].vertices;
      for (std::size_t k = 2; k < corners.size(); ++k) {
        const pcl::index_t triangle[3] = {corners[0], corners[k - 1], corners[k]};
        if (!std::all_of(triangle, triangle + 3,
                         [&](pcl::index_t i) { return vertices[i].getVector3fMap().allFinite(); }))
          continue;
        for (const pcl::index_t corner : triangle) {
          const Eigen::Vector3f x = normalize_(vertices[corner].getVector3fMap().cast<double>()).cast<float>();
          triangles_.insert(triangles_.end(), x.data(), x.data() + 3);
          corner_of_.push_back(static_cast<std::size_t>(corner));
        }
        face_of_.push_back(f);
      }
    }
    num_vertices_ = vertices.size();
  }

  std::string positions() const {
    std::vector<float> values;
    for (const std::size_t i : kept_) {
      const Eigen::Vector3f x = normalize_((*scene_.points)[i].getVector3fMap().cast<double>()).cast<float>();
      values.insert(values.end(), x.data(), x.data() + 3);
    }
    return base64(values);
  }

  /// In units of 1/127; empty if there are none.
  std::string normals() const {
    const Points all = pointNormals(*scene_.points, normalize_);
    std::vector<std::int8_t> values;
    for (const std::size_t i : kept_) {
      const auto n = all.col(static_cast<Eigen::Index>(i));
      if (!n.allFinite()) return "";
      for (int k = 0; k < 3; ++k) values.push_back(static_cast<std::int8_t>(std::lround(127.0f * n[k])));
    }
    return base64(values);
  }

  nlohmann::json panelJson(const PicturePanel& panel) const {
    const bool of_faces = !panel.segments.empty() && scene_.mesh;
    const bool on_points = !panel.support.empty() || (!panel.segments.empty() && !scene_.mesh);
    const PointShade shade = shadeOf(on_points);
    nlohmann::json json{{"label", panel.label},
                        {"show_points", panel.show_points && !of_faces},
                        {"has_support", scene_.show_color_bar && !panel.support.empty()},
                        {"shade", {shade.least, shade.range}},
                        {"point_colors", nullptr},
                        {"mesh_colors", nullptr},
                        {"planes", nlohmann::json::array()},
                        {"axes", nlohmann::json::array()},
                        {"segments", segmentSwatches(panel)}};
    if (on_points) json["point_colors"] = pointColors(panel);
    if (of_faces || (!panel.show_points && num_vertices_ == panel.support.size() && num_vertices_ > 0))
      json["mesh_colors"] = meshColors(panel);
    for (const PlanePatch& plane : panel.planes) {
      nlohmann::json corners = nlohmann::json::array();
      for (const Eigen::Vector3d& corner : patchCorners(plane, scene_)) corners.push_back(numbers(normalize_(corner)));
      json["planes"].push_back({{"corners", corners}, {"color", numbers(plane.color)}});
    }
    for (const AxisLine& axis : panel.axes) {
      const auto [begin, end] = axisEnds(axis, scene_);
      json["axes"].push_back(
          {{"ends", {numbers(normalize_(begin)), numbers(normalize_(end))}}, {"color", numbers(axis.color)}});
    }
    return json;
  }

  static nlohmann::json segmentSwatches(const PicturePanel& panel) {
    nlohmann::json swatches = nlohmann::json::array();
    const std::set<int> shown(panel.segments.begin(), panel.segments.end());
    if (shown.size() > kMostSwatches) return swatches;
    for (const int segment : shown)
      if (segment >= 0) swatches.push_back({{"color", numbers(segmentColor(segment))}});
    return swatches;
  }

  std::string pointColors(const PicturePanel& panel) const {
    std::vector<std::uint8_t> bytes;
    for (const std::size_t i : kept_) addColor(pointColor(panel, i), bytes);
    return base64(bytes);
  }

  std::string meshColors(const PicturePanel& panel) const {
    std::vector<std::uint8_t> bytes;
    for (std::size_t corner = 0; corner < corner_of_.size(); ++corner)
      addColor(panel.segments.empty() ? cividis(panel.support[corner_of_[corner]])
                                      : segmentColor(panel.segments[face_of_[corner / 3]]),
               bytes);
    return base64(bytes);
  }

  const PictureScene& scene_;
  Normalization normalize_;
  std::vector<std::size_t> kept_;       ///< indices of the points of the page
  std::vector<float> triangles_;        ///< nine numbers each
  std::vector<std::size_t> corner_of_;  ///< vertex of each corner of a triangle
  std::vector<std::size_t> face_of_;    ///< polygon of each triangle
  std::size_t num_vertices_ = 0;
};

}  // namespace

void writePage(const PictureScene& scene, const PageText& text, const std::string& path) {
  // Within a script, only "</" can end the script.
  const std::string json = PageScene(scene).json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::string safe = boost::algorithm::replace_all_copy(json, "</", "<\\/");
  writeText(path, std::string(kPageHead) + kPageLibrary + "</script>\n<script type=\"application/json\" id=\"scene\">" +
                      safe + "</script>\n<script>\n" + kPageViewer + "</script>\n</body>\n</html>\n");
}

}  // namespace pcl_symmetry::apps
