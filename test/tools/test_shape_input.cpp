/// Shapes as other programs write them: what they mean is read, and what is left out is said.
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <sys/stat.h>

#include <cstring>
#include <limits>
#include <thread>

#include "io/shape_input.h"
#include "io/shape_readers.h"
#include "shapes/temporary_folder.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types, int width, int height,
                int points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data;
}

const std::string kPLYVertex = "property float x\nproperty float y\nproperty float z\n";
const std::string kSquare = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n";

std::string ply(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

class LoadShape : public testing::Test {
protected:
  Shape read(const std::string& name, const std::string& content) const {
    return loadShape(folder_.write(name, content));
  }
  const TemporaryFolder folder_;
};

/// Binary glTF: 12 bytes of header, a chunk of JSON, a chunk of values.
std::string glb(const std::string& primitive, const std::string& values) {
  std::string text =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[0,0,5]}],)"
      R"("meshes":[{"primitives":[)" +
      primitive + R"(]}],"buffers":[{"byteLength":)" + std::to_string(values.size()) + R"(}],)" +
      R"("bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],)" +
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[2,1,0]}]})";
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto number = [](std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&narrow), 4);
  };
  return "glTF" + number(2) + number(28 + text.size() + values.size()) + number(text.size()) + "JSON" + text +
         number(values.size()) + std::string("BIN\0", 4) + values;
}

TEST_F(LoadShape, ReadsMeshesOfEveryKind) {
  folder_.write("plain.off", "OFF\n4 2 0\n" + kSquare + "3 0 1 2\n4 0 1 2 3\n");
  folder_.write("same_line.off", "OFF 4 2 0\n# comment\n" + kSquare + "3 0 1 2 255 0 0\n4 0 1 2 3\n");
  folder_.write("glued.OFF", "OFF4 2 0\n" + kSquare + "3 0 1 2\n4 0 1 2 3\n2 0 1\n"),
      folder_.write("color.off",
                    "COFF\n4 2 0\n0 0 0 9 9 9 9\n2 0 0 9 9 9 9\n2 1 0 9 9 9 9\n0 1 0 9 9 9 9\n3 0 1 2\n4 0 1 2 3\n");
  folder_.write("text.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3\nf 1 2 3 4\n");
  folder_.write(
      "text.ply",
      ply("ascii", "element vertex 4\n" + kPLYVertex + "element face 2\nproperty list uchar int vertex_indices\n",
          kSquare + "3 0 1 2\n4 0 1 2 3\n"));
  for (const char* name : {"plain.off", "same_line.off", "glued.OFF", "color.off", "text.obj", "text.ply"}) {
    const Shape shape = loadShape(folder_ / name);
    ASSERT_TRUE(shape.mesh) << name;
    EXPECT_EQ(shape.points->size(), 4u) << name;
    ASSERT_EQ(shape.mesh->polygons.size(), 2u) << name;
    EXPECT_EQ(shape.mesh->polygons[0].vertices.size(), 3u) << name;
    EXPECT_EQ(shape.mesh->polygons[1].vertices.size(), 4u) << name;
    const auto& corner = (*shape.points)[static_cast<std::size_t>(shape.mesh->polygons[1].vertices[2])];
    EXPECT_EQ(corner.getVector3fMap(), Eigen::Vector3f(2, 1, 0)) << name;
  }
}

TEST_F(LoadShape, JoinsTheRepeatedCornersOfSTL) {
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
  };
  folder_.write("square.stl",
                "solid s\n" + facet("0 0 0", "2 0 0", "2 1 0") + facet("0 0 0", "2 1 0", "0 1 0") + "endsolid s\n");
  const Shape shape = loadShape(folder_ / "square.stl");
  EXPECT_EQ(shape.points->size(), 4u);
  EXPECT_EQ(shape.mesh->polygons.size(), 2u);
}

TEST_F(LoadShape, ReadsThePointsOfRangeGrids) {
  const std::string info = "obj_info num_cols 3\nobj_info num_rows 1\n";
  const std::string grid = "element range_grid 3\nproperty list uchar int vertex_indices\n";
  const std::string text = ply("ascii", info + "element vertex 2\n" + kPLYVertex + grid, "1 2 3\n4 5 6\n1 0\n0\n1 1\n");
  const Shape shape = read("grid.ply", text);
  ASSERT_EQ(shape.points->size(), 2u);
  EXPECT_EQ((*shape.points)[1].x, 4.0f);
}

TEST_F(LoadShape, ShiftsNothingWhereTheExtentIsNoNormalNumber) {
  for (const std::string x : {"1e300", "0", "1"}) {
    const std::string points = x + " 0 0\n" + x + " 5e-324 0\n";
    const Shape shape = read("tiny.pcd", pcd("x y z", "8 8 8", "F F F", 2, 1, 2, "ascii\n" + points));
    EXPECT_TRUE(shape.shift.isZero(0.0)) << x;
    EXPECT_EQ(shape.points->size(), 2u);
  }
}

TEST_F(LoadShape, ReadsPointsOfColumnsAndOfFilesWithoutFaces) {
  folder_.write("a.xyz", "# x y z red\n0 0 0 255\n\n2 1 0.5 0 0\n");
  folder_.write("a.obj", "# points\nv 0 0 0\n  v 2 1 0.5\n");
  folder_.write("a.off", "OFF\n2 0 0\n0 0 0\n2 1 0.5\n");
  for (const char* name : {"a.xyz", "a.obj", "a.off"}) {
    const Shape shape = loadShape(folder_ / name);
    EXPECT_FALSE(shape.mesh) << name;
    ASSERT_EQ(shape.points->size(), 2u) << name;
    EXPECT_EQ((*shape.points)[1].getVector3fMap(), Eigen::Vector3f(2, 1, 0.5f)) << name;
    EXPECT_TRUE(shape.shift.isZero(0.0)) << name;
  }
}

TEST_F(LoadShape, ReadsBinaryGlTF) {
  const float corners[9] = {0, 0, 0, 2, 0, 0, 2, 1, 0};
  const std::string values(reinterpret_cast<const char*>(corners), sizeof(corners));
  const Shape mesh = loadShape(folder_.write("mesh.glb", glb(R"({"attributes":{"POSITION":0},"mode":4})", values)));
  ASSERT_TRUE(mesh.mesh);
  EXPECT_EQ(mesh.mesh->polygons.size(), 1u);
  EXPECT_EQ(mesh.points->at(2).getVector3fMap(), Eigen::Vector3f(2, 1, 5)) << "in the frame of the scene";
  const Shape points = loadShape(folder_.write("points.glb", glb(R"({"attributes":{"POSITION":0},"mode":0})", values)));
  EXPECT_FALSE(points.mesh);
  ASSERT_EQ(points.points->size(), 3u);
  EXPECT_EQ(points.points->at(1).getVector3fMap(), Eigen::Vector3f(2, 0, 5));
  const Shape fan = loadShape(folder_.write("fan.glb", glb(R"({"attributes":{"POSITION":0},"mode":6})", values)));
  ASSERT_TRUE(fan.mesh);
  EXPECT_EQ(fan.mesh->polygons.size(), 1u);
}

/// Map coordinates of a square of one meter, which float cannot tell apart: its spacing there is half a meter.
TEST_F(LoadShape, ShiftsCoordinatesThatFloatCannotHold) {
  const std::string a = "500000.25 5000000.125 100", b = "500001.25 5000000.125 100", c = "500001.25 5000001.125 100";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  folder_.write("a.off", "OFF\n3 1 0\n" + a + "\n" + b + "\n" + c + "\n3 0 1 2\n");
  folder_.write("a.obj", "v " + a + "\nv " + b + "\nv " + c + "\nf 1 2 3\n");
  folder_.write("a.xyz", a + "\n" + b + "\n" + c + "\n");
  folder_.write("a.pcd", pcd("x y z", "8 8 8", "F F F", 3, 1, 3, "ascii\n" + a + "\n" + b + "\n" + c + "\n"));
  folder_.write("a.ply",
                ply("ascii", "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + faces,
                    a + "\n" + b + "\n" + c + "\n3 0 1 2\n"));
  for (const char* name : {"a.off", "a.obj", "a.xyz", "a.pcd", "a.ply"}) {
    const Shape shape = loadShape(folder_ / name);
    EXPECT_FALSE(shape.shift.isZero(0.0)) << name;
    ASSERT_EQ(shape.points->size(), 3u) << name;
    const Eigen::Vector3d expected[3] = {
        {500000.25, 5000000.125, 100.0}, {500001.25, 5000000.125, 100.0}, {500001.25, 5000001.125, 100.0}};
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d point = (*shape.points)[i].getVector3fMap().cast<double>() + shape.shift;
      EXPECT_EQ(point, expected[i]) << name << ": the shift is exact";
      Eigen::Vector3d field;
      for (int k = 0; k < 3; ++k)
        std::memcpy(&field[k], &shape.cloud.data[i * shape.cloud.point_step + shape.cloud.fields[k].offset], 8);
      EXPECT_EQ(field, expected[i]) << name << ": fields stay in the input frame";
    }
    if (!shape.mesh) continue;
    pcl::PointCloud<pcl::PointXYZ> vertices;
    pcl::fromPCLPointCloud2(shape.mesh->cloud, vertices);
    EXPECT_EQ(vertices.at(2).getVector3fMap(), (*shape.points)[2].getVector3fMap()) << name;
  }
  const Shape near = read("near.off", "OFF\n3 1 0\n7 7 7\n8 7 7\n8 8 7\n3 0 1 2\n");
  EXPECT_TRUE(near.shift.isZero(0.0)) << "float is precise enough";
}

template <typename Value>
std::string bytesOf(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

Eigen::MatrixXf pointsOf(const Shape& shape) {
  return shape.points->getMatrixXfMap(3, 4, 0);
}

TEST_F(LoadShape, PLYListsOfAnyType) {
  for (const std::string length : {"char", "uchar", "short", "ushort", "int", "uint", "int8", "uint32"})
    for (const std::string index : {"char", "uchar", "short", "ushort", "int", "uint", "uint16"}) {
      const Shape shape =
          read("a.ply", ply("ascii",
                            "element vertex 4\n" + kPLYVertex + "element face 2\nproperty uchar flags\nproperty list " +
                                length + " " + index + " vertex_index\n",
                            kSquare + "7 3 0 1 2\n7 4 0 1 2 3\n"));
      ASSERT_TRUE(shape.mesh) << length << " " << index;
      ASSERT_EQ(shape.mesh->polygons.size(), 2u);
      EXPECT_EQ(shape.mesh->polygons[1].vertices, (pcl::Indices{0, 1, 2, 3})) << length << " " << index;
      EXPECT_TRUE(shape.left_out.empty());
    }
  std::string body = bytesOf<float>({0, 0, 0, 2, 0, 0, 2, 1, 0});
  body += bytesOf<std::uint16_t>({3}) + bytesOf<std::uint32_t>({2, 1, 0});
  const std::string elements =
      "element vertex 3\n" + kPLYVertex + "element face 1\nproperty list ushort uint vertex_indices\n";
  EXPECT_EQ(read("b.ply", ply("binary_little_endian", elements, body)).mesh->polygons.at(0).vertices,
            (pcl::Indices{2, 1, 0}));
  std::string big;
  for (std::size_t i = 0; i < body.size();) {
    const std::size_t size = i == 36 ? 2 : 4;
    std::string value = body.substr(i, size);
    std::reverse(value.begin(), value.end());
    big += value;
    i += size;
  }
  EXPECT_EQ(read("c.ply", ply("binary_big_endian", elements, big)).mesh->polygons.at(0).vertices,
            (pcl::Indices{2, 1, 0}));
}

TEST_F(LoadShape, PLYStripsOfTriangles) {
  const Shape shape = read(
      "a.ply",
      ply("ascii", "element vertex 4\n" + kPLYVertex + "element tristrips 1\nproperty list int int vertex_indices\n",
          kSquare + "8 0 1 3 2 -1 0 1 2\n"));
  ASSERT_TRUE(shape.mesh);
  ASSERT_EQ(shape.mesh->polygons.size(), 3u);
  EXPECT_EQ(shape.mesh->polygons[0].vertices, (pcl::Indices{0, 1, 3}));
  EXPECT_EQ(shape.mesh->polygons[1].vertices, (pcl::Indices{3, 1, 2})) << "the same side is in front";
  EXPECT_EQ(shape.mesh->polygons[2].vertices, (pcl::Indices{0, 1, 2}));
}

TEST_F(LoadShape, PLYPropertiesOfAnyTypeAndOrder) {
  std::string body;
  for (int i = 0; i < 2; ++i) body += bytesOf<std::uint8_t>({9}) + bytesOf<float>({1.5f + static_cast<float>(i), 2, 3});
  const Shape red =
      read("a.ply", ply("binary_little_endian", "element vertex 2\nproperty uchar red\n" + kPLYVertex, body));
  EXPECT_EQ(pointsOf(red).col(1), Eigen::Vector3f(2.5f, 2, 3));
  const Shape colored = read(
      "b.ply", ply("ascii",
                   "element vertex 1\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float "
                   "z\nproperty float nx\nproperty float x\nproperty float y\n",
                   "1 2 3 7 0.5 8 9\n"));
  EXPECT_EQ(pointsOf(colored).col(0), Eigen::Vector3f(8, 9, 7));
  EXPECT_EQ(colored.cloud.fields[0].name, "rgb");
  EXPECT_EQ(colored.cloud.fields[2].name, "normal_x");
  EXPECT_EQ(std::memcmp(colored.cloud.data.data(), "\3\2\1\0", 4), 0);
  const Shape whole =
      read("c.ply",
           ply("ascii", "element vertex 2\nproperty int x\nproperty short y\nproperty uchar z\n", "-5 6 7\n1 2 3\n"));
  EXPECT_EQ(pointsOf(whole).col(0), Eigen::Vector3f(-5, 6, 7));
  const Shape lists = read("d.ply", ply("ascii",
                                        "element vertex 2\nproperty list uchar int parts\n" + kPLYVertex +
                                            "element edge 1\nproperty int a\n",
                                        "2 0 0 1 2 3\n0 4 5 6\n7\n"));
  EXPECT_EQ(pointsOf(lists).col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(lists.left_out, (std::vector<std::string>{"list parts of the vertices", "1 of element edge"}));
  const std::string camera = "element camera 1\nproperty float viewportx\nproperty float viewporty\n";
  const Shape no_grid =
      read("e.ply", ply("ascii", camera + "element vertex 3\n" + kPLYVertex, "1.5 2\n1 2 3\n4 5 6\n7 8 9\n"));
  EXPECT_EQ(no_grid.points->width, 3u) << "pixels are whole";
}

TEST_F(LoadShape, PCDWithEmptyPaddingAndWholeCoordinates) {
  const Shape empty =
      read("a.pcd", pcd("x y z _ ring _", "4 4 4 1 1 1", "F F F U U U\nCOUNT 1 1 1 0 1 3", 2, 1, 2,
                        "binary\n" + bytesOf<float>({1, 2, 3}) + "\7..." + bytesOf<float>({4, 5, 6}) + "\t..."));
  EXPECT_EQ(pointsOf(empty).col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(empty.cloud.fields.back().name, "ring");
  EXPECT_EQ(empty.cloud.data.at(empty.cloud.point_step + empty.cloud.fields.back().offset), '\t');
  const Shape whole = read("b.pcd", pcd("x y z", "2 4 1", "I I U", 2, 1, 2, "ascii\n-1 70000 3\n4 5 6\n"));
  EXPECT_EQ(pointsOf(whole).col(0), Eigen::Vector3f(-1, 70000, 3));
}

TEST_F(LoadShape, OBJThatNamesTexturesAndNormalsItDoesNotHave) {
  const std::string vertices = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";
  for (const std::string faces : {"f 1/1/1 2/2/2 3/3/3 4/4/4\n", "f 1//7 2//7 3//7 4//7\n", "f 1/5 2/6 3/7 4/8\n",
                                  "f -4 -3 -2 -1\n", "f 1 2 \\\n 3 4\r\n"}) {
    const Shape shape = read("a.obj", "mtllib no_such.mtl\no part\n" + vertices + "usemtl red\ns off\n" + faces);
    ASSERT_TRUE(shape.mesh) << faces;
    ASSERT_EQ(shape.mesh->polygons.size(), 1u);
    EXPECT_EQ(shape.mesh->polygons[0].vertices, (pcl::Indices{0, 1, 2, 3})) << faces;
    EXPECT_EQ(pointsOf(shape).col(2), Eigen::Vector3f(2, 1, 0));
  }
}

TEST_F(LoadShape, STLWithBytesBehindItAndWordsBeforeIt) {
  const std::string triangle(bytesOf<float>({0, 0, 1, 0, 0, 0, 2, 0, 0, 2, 1, 0}) + std::string(2, '\0'));
  const std::string binary = std::string(80, ' ') + std::string("\1\0\0\0", 4) + triangle;
  for (const std::string behind : {"", "\n", "1234567"}) {
    const Shape shape = read("a.stl", binary + behind);
    ASSERT_TRUE(shape.mesh);
    EXPECT_EQ(pointsOf(shape).col(2), Eigen::Vector3f(2, 1, 0)) << behind.size();
  }
  const std::string text =
      "solid s\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 2 0 0\n   vertex 2 1 0\n  endloop\n "
      "endfacet\nendsolid s\n";
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  for (const std::string& content : {text, capitals, "\n\n" + text, "# made by hand\n" + text, "\t" + text}) {
    const Shape shape = read("b.stl", content);
    ASSERT_TRUE(shape.mesh) << content;
    EXPECT_EQ(pointsOf(shape).col(2), Eigen::Vector3f(2, 1, 0)) << content;
  }
}

TEST_F(LoadShape, ColumnsOfText) {
  const std::pair<const char*, const char*> files[] = {
      {"cloud_compare.xyz", "//X Y Z\n1 2 3\n4 5 6\n"},
      {"words.xyz", "X Y Z R G B\n1 2 3 9 9 9\n4 5 6 9 9 9\n"},
      {"commas.txt", "1,2,3\n4,5,6\n"},
      {"mark.xyz",
       "\xef\xbb\xbf"
       "1 2 3\r\n4 5 6\r\n"},
      {"count.pts", "2\n1 2 3 -2047 9 9 9\n4 5 6 -2047 9 9 9\n"},
      {"semicolons.csv", "1;2;3\n4;5;6\n"},
      {"decimal_commas.csv", "1,0;2,0;3,0\n4,0;5,0;6,0\n"},
      {"tabs.asc", "1\t2\t3\n4\t5\t6\n"},
      {"names.csv", "time,\"x\",\"y\",\"z\",id\n0.5,1,2,3,a\n0.6,4,5,6,b\n"},
      {"paraview.csv", "\"Temp\",\"Points:0\",\"Points:1\",\"Points:2\"\n7,1,2,3\n7,4,5,6\n"},
      {"last_cell_empty.csv", "id,x,y,z,comment\n7,1,2,3,\n8,4,5,6,\n"},
      {"labels.csv", "point,1,2,3\npoint,4,5,6\n"},
      {"title.txt", "Points of a box\n\n1 2 3\n4 5 6\n"},
      {"sentence.xyz", "# made from x y z\n1 2 3\n4 5 6\n"},
      {"spaced.csv", " x , y , z \n 1 , 2 , 3 ,\n 4 , 5 , 6 ,\n"}};
  for (const auto& [name, content] : files) {
    const Shape shape = read(name, content);
    ASSERT_EQ(shape.points->size(), 2u) << name;
    EXPECT_EQ(pointsOf(shape).col(0), Eigen::Vector3f(1, 2, 3)) << name;
    EXPECT_EQ(pointsOf(shape).col(1), Eigen::Vector3f(4, 5, 6)) << name;
    const bool has_more = std::string(content).find('9') != std::string::npos || std::string(name) == "names.csv";
    EXPECT_TRUE(!has_more || shape.left_out.size() == 1) << name;
  }
}

TEST_F(LoadShape, Pipes) {
  for (const std::string name : {"pipe.xyz", "pipe"}) {  // the second as <(...) of a shell
    ASSERT_EQ(::mkfifo((folder_ / name).c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(folder_ / name) << "1 2 3\n4 5 6\n"; });
    const Shape shape = loadShape(folder_ / name);
    writer.join();
    EXPECT_EQ(shape.points->size(), 2u) << name;
  }
}

const pcl::PCLPointField* fieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

TEST(ReadPCD, ReadsIntegersOfEverySizeAndSeveralValues) {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "a.pcd",
      "VERSION 0.7\nFIELDS x y z i u big pair\nSIZE 4 4 4 1 2 8 4\nTYPE F F F I U U U\nCOUNT 1 1 1 1 1 1 2\nWIDTH 1\n"
      "HEIGHT 1\nPOINTS 1\nDATA ascii\n+1 2.5e0 nan -128 65535 18446744073709551615 7 4294967295\n");
  const pcl::PCLPointCloud2 cloud = readPCD(path, contentOf(path)).cloud;
  EXPECT_FALSE(cloud.is_dense);
  const auto at = [&](const char* name) { return cloud.data.data() + fieldOf(cloud, name)->offset; };
  EXPECT_EQ(*reinterpret_cast<const std::int8_t*>(at("i")), -128);
  std::uint16_t u;
  std::memcpy(&u, at("u"), 2);
  EXPECT_EQ(u, 65535);
  std::uint64_t big;
  std::memcpy(&big, at("big"), 8);
  EXPECT_EQ(big, std::numeric_limits<std::uint64_t>::max());
  std::uint32_t pair[2];
  std::memcpy(pair, at("pair"), 8);
  EXPECT_EQ(pair[0], 7u);
  EXPECT_EQ(pair[1], 4294967295u);
}

}  // namespace
