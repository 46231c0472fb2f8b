/// Files as other programs write them: what they mean is read, and what is left out is said.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <thread>

#include "io/shape_input.h"
#include "tools/temporary_folder.h"

namespace {

using namespace pcl_symmetry::apps;

template <typename Value>
std::string bytesOf(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

Eigen::MatrixXf pointsOf(const Shape& shape) {
  return shape.points->getMatrixXfMap(3, 4, 0);
}

class FileVariants : public testing::Test {
protected:
  Shape read(const std::string& name, const std::string& content) const {
    return loadShape(folder_.write(name, content));
  }
  std::string complaint(const std::string& name, const std::string& content) const {
    try {
      read(name, content);
    } catch (const InputError& error) {
      return error.what();
    }
    return "was read";
  }
  const TemporaryFolder folder_;
};

const std::string kVertices = "property float x\nproperty float y\nproperty float z\n";
const std::string kSquare = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n";

std::string plyText(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

TEST_F(FileVariants, PLYListsOfAnyType) {
  for (const std::string length : {"char", "uchar", "short", "ushort", "int", "uint", "int8", "uint32"})
    for (const std::string index : {"char", "uchar", "short", "ushort", "int", "uint", "uint16"}) {
      const Shape shape = read(
          "a.ply", plyText("ascii",
                           "element vertex 4\n" + kVertices + "element face 2\nproperty uchar flags\nproperty list " +
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
      "element vertex 3\n" + kVertices + "element face 1\nproperty list ushort uint vertex_indices\n";
  EXPECT_EQ(read("b.ply", plyText("binary_little_endian", elements, body)).mesh->polygons.at(0).vertices,
            (pcl::Indices{2, 1, 0}));
  std::string big;
  for (std::size_t i = 0; i < body.size();) {
    const std::size_t size = i == 36 ? 2 : 4;
    std::string value = body.substr(i, size);
    std::reverse(value.begin(), value.end());
    big += value;
    i += size;
  }
  EXPECT_EQ(read("c.ply", plyText("binary_big_endian", elements, big)).mesh->polygons.at(0).vertices,
            (pcl::Indices{2, 1, 0}));
}

TEST_F(FileVariants, PLYStripsOfTriangles) {
  const Shape shape = read(
      "a.ply",
      plyText("ascii", "element vertex 4\n" + kVertices + "element tristrips 1\nproperty list int int vertex_indices\n",
              kSquare + "8 0 1 3 2 -1 0 1 2\n"));
  ASSERT_TRUE(shape.mesh);
  ASSERT_EQ(shape.mesh->polygons.size(), 3u);
  EXPECT_EQ(shape.mesh->polygons[0].vertices, (pcl::Indices{0, 1, 3}));
  EXPECT_EQ(shape.mesh->polygons[1].vertices, (pcl::Indices{3, 1, 2})) << "the same side is in front";
  EXPECT_EQ(shape.mesh->polygons[2].vertices, (pcl::Indices{0, 1, 2}));
}

TEST_F(FileVariants, PLYPropertiesOfAnyTypeAndOrder) {
  std::string body;
  for (int i = 0; i < 2; ++i) body += bytesOf<std::uint8_t>({9}) + bytesOf<float>({1.5f + static_cast<float>(i), 2, 3});
  const Shape red =
      read("a.ply", plyText("binary_little_endian", "element vertex 2\nproperty uchar red\n" + kVertices, body));
  EXPECT_EQ(pointsOf(red).col(1), Eigen::Vector3f(2.5f, 2, 3));
  const Shape colored =
      read("b.ply",
           plyText("ascii",
                   "element vertex 1\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty float "
                   "z\nproperty float nx\nproperty float x\nproperty float y\n",
                   "1 2 3 7 0.5 8 9\n"));
  EXPECT_EQ(pointsOf(colored).col(0), Eigen::Vector3f(8, 9, 7));
  EXPECT_EQ(colored.cloud.fields[0].name, "rgb");
  EXPECT_EQ(colored.cloud.fields[2].name, "normal_x");
  EXPECT_EQ(std::memcmp(colored.cloud.data.data(), "\3\2\1\0", 4), 0);
  const Shape whole = read(
      "c.ply",
      plyText("ascii", "element vertex 2\nproperty int x\nproperty short y\nproperty uchar z\n", "-5 6 7\n1 2 3\n"));
  EXPECT_EQ(pointsOf(whole).col(0), Eigen::Vector3f(-5, 6, 7));
  const Shape lists = read("d.ply", plyText("ascii",
                                            "element vertex 2\nproperty list uchar int parts\n" + kVertices +
                                                "element edge 1\nproperty int a\n",
                                            "2 0 0 1 2 3\n0 4 5 6\n7\n"));
  EXPECT_EQ(pointsOf(lists).col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(lists.left_out, (std::vector<std::string>{"list parts of the vertices", "1 of element edge"}));
}

TEST_F(FileVariants, PLYThatIsWrongIsRefusedWithTheReason) {
  const std::string face =
      "element vertex 4\n" + kVertices + "element face 1\nproperty list uchar int vertex_indices\n";
  for (const auto& [wrong, said] : {std::pair("3 0 1 4\n", "a corner of face 0 = 4, must be >= 0 and < 4"),
                                    std::pair("3 0 1 -1\n", "a corner of face 0 = -1"),
                                    std::pair("3 0 1 x\n", "vertex_indices of face 0 = x, must be a number"),
                                    std::pair("-3 0 1 2\n", "length of list vertex_indices of face 0")})
    EXPECT_NE(complaint("a.ply", plyText("ascii", face, kSquare + wrong)).find(said), std::string::npos) << wrong;
}

std::string pcdText(const std::string& fields, const std::string& sizes, const std::string& types,
                    const std::string& counts, const std::string& data) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts +
         "\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA " + data;
}

TEST_F(FileVariants, PCDWithEmptyPaddingAndWholeCoordinates) {
  const Shape empty =
      read("a.pcd", pcdText("x y z _ ring _", "4 4 4 1 1 1", "F F F U U U", "1 1 1 0 1 3",
                            "binary\n" + bytesOf<float>({1, 2, 3}) + "\7..." + bytesOf<float>({4, 5, 6}) + "\t..."));
  EXPECT_EQ(pointsOf(empty).col(1), Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(empty.cloud.fields.back().name, "ring");
  EXPECT_EQ(empty.cloud.data.at(empty.cloud.point_step + empty.cloud.fields.back().offset), '\t');
  const Shape whole = read("b.pcd", pcdText("x y z", "2 4 1", "I I U", "1 1 1", "ascii\n-1 70000 3\n4 5 6\n"));
  EXPECT_EQ(pointsOf(whole).col(0), Eigen::Vector3f(-1, 70000, 3));
}

TEST_F(FileVariants, OBJThatNamesTexturesAndNormalsItDoesNotHave) {
  const std::string vertices = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";
  for (const std::string faces : {"f 1/1/1 2/2/2 3/3/3 4/4/4\n", "f 1//7 2//7 3//7 4//7\n", "f 1/5 2/6 3/7 4/8\n",
                                  "f -4 -3 -2 -1\n", "f 1 2 \\\n 3 4\r\n"}) {
    const Shape shape = read("a.obj", "mtllib no_such.mtl\no part\n" + vertices + "usemtl red\ns off\n" + faces);
    ASSERT_TRUE(shape.mesh) << faces;
    ASSERT_EQ(shape.mesh->polygons.size(), 1u);
    EXPECT_EQ(shape.mesh->polygons[0].vertices, (pcl::Indices{0, 1, 2, 3})) << faces;
    EXPECT_EQ(pointsOf(shape).col(2), Eigen::Vector3f(2, 1, 0));
  }
  EXPECT_NE(complaint("a.obj", vertices + "f 1 2 5\n").find("a corner of face 0 = 5, must be <= 4"), std::string::npos);
  EXPECT_NE(complaint("a.obj", vertices + "f 1 2 0\n").find("a corner of face 0 = 0"), std::string::npos);
}

TEST_F(FileVariants, STLWithBytesBehindItAndWordsBeforeIt) {
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

TEST_F(FileVariants, ColumnsOfText) {
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

TEST_F(FileVariants, ColumnsThatAreWrongAreRefusedWithTheLine) {
  EXPECT_NE(complaint("a.csv", "x,y,z\n1,2,3\n1,b,3\n").find("line 3 has y = b, must be a number"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "1,2,3\n1,2\n").find("line 2 has 2 columns, must have at least 3"), std::string::npos);
  EXPECT_NE(complaint("a.xyz", "1 2\n").find("line 1 = 1 2, must hold three numbers"), std::string::npos);
  EXPECT_NE(complaint("a.pts", "3\n1 2 3\n").find("holds 1 points, its first line says 3"), std::string::npos);
  EXPECT_NE(complaint("a.csv", "1,,3\n1,2,3\n").find("line 1"), std::string::npos);
  EXPECT_NE(complaint("a.txt", "Dear reader,\nhello\n").find("has no points"), std::string::npos);
}

TEST_F(FileVariants, Pipes) {
  for (const std::string name : {"pipe.xyz", "pipe"}) {  // the second as <(...) of a shell
    ASSERT_EQ(::mkfifo((folder_ / name).c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(folder_ / name) << "1 2 3\n4 5 6\n"; });
    const Shape shape = loadShape(folder_ / name);
    writer.join();
    EXPECT_EQ(shape.points->size(), 2u) << name;
  }
}

}  // namespace
