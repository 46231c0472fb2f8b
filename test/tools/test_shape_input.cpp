#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstring>

#include "io/shape_input.h"
#include "tools/temporary_folder.h"

namespace {

using namespace pcl_symmetry::apps;

std::string pcd(const std::string& fields, const std::string& sizes, const std::string& types, int width, int height,
                int points, const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data;
}

std::string plainPCD(int points, const std::string& data) {
  return pcd("x y z", "4 4 4", "F F F", points, 1, points, data);
}

const char* const kPLYVertex = "property float x\nproperty float y\nproperty float z\n";

std::string ply(const std::string& format, const std::string& elements, const std::string& body) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + body;
}

/// \return the complaint, checked to be one line that names the file.
std::string complaintOnReading(const std::string& path) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string message;
  try {
    loadShape(path);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "") << path;
  EXPECT_EQ(message.rfind(path + ": ", 0), 0u) << "'" << message << "' for " << path;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message;
}

struct BadFile {
  std::string name, content, complaint;
};

TEST(LoadShape, RefusesBadFilesWithOneLine) {
  const std::string raw(12, '\1');
  const std::vector<BadFile> files = {
      {"empty.pcd", "", "is empty"},
      {"headerless.pcd", "1 2 3\n4 5 6\n", "has no PCD header"},
      {"garbage.pcd", std::string("\x7f\x45\0\1\2\3\xff\xfe", 8), "has no PCD header"},
      {"cut.pcd", "VERSION 0.7\nFIELDS x y z\n", "ends before DATA"},
      {"no_z.pcd", pcd("x y", "4 4", "F F", 1, 1, 1, "ascii\n1 2\n"), "has no field z"},
      {"no_xyz.pcd", pcd("a b c", "4 4 4", "F F F", 1, 1, 1, "ascii\n1 2 3\n"), "has no field x"},
      {"short_size.pcd", pcd("x y z", "4 4", "F F F", 1, 1, 1, "ascii\n1 2 3\n"), "SIZE has 2 entries, must be 3"},
      {"bad_size.pcd", pcd("x y z", "4 4 3", "F F F", 1, 1, 1, "ascii\n1 2 3\n"), "TYPE and SIZE of z = F 3"},
      {"product.pcd", pcd("x y z", "4 4 4", "F F F", 2, 2, 3, "ascii\n1 2 3\n"), "must be WIDTH * HEIGHT = 4"},
      {"negative.pcd", plainPCD(-1, "ascii\n"), "WIDTH = -1"},
      {"no_points.pcd", plainPCD(0, "ascii\n"), "POINTS = 0, must be > 0"},
      {"data.pcd", plainPCD(1, "zip\n1 2 3\n"), "DATA = zip"},
      {"too_few.pcd", plainPCD(3, "ascii\n1.25 2.25 3.25\n4.25 5.25 6.25\n"), "holds 2 points, POINTS = 3"},
      {"letters.pcd", plainPCD(1, "ascii\n1 two 3\n"), "not a number"},
      {"row.pcd", plainPCD(2, "ascii\n1 2 3\n4.55555 5\n"), "has 2 values, must be 3"},
      {"huge.pcd", plainPCD(2000000000, "ascii\n1 2 3\n"), "must be >= "},
      {"huge_binary.pcd", plainPCD(2000000000, "binary\n" + raw), "must be >= 24000000000"},
      {"cut_binary.pcd", plainPCD(2, "binary\n" + raw), "holds 12 bytes of points"},
      {"cut_compressed.pcd", plainPCD(2, "binary_compressed\n" + raw.substr(0, 5)), "ends before the sizes"},
      {"sizes_compressed.pcd", plainPCD(2, "binary_compressed\n" + raw), "compressed size = "},
      {"damaged_compressed.pcd",
       plainPCD(1, "binary_compressed\n" + std::string("\3\0\0\0\14\0\0\0", 8) + "\xff\xff\xff"), "damaged"},
      {"empty.ply", "", "is empty"},
      {"garbage.ply", "hello\n", "does not begin with ply"},
      {"cut.ply", "ply\nformat ascii 1.0\n", "ends before end_header"},
      {"format.ply", ply("zip", std::string("element vertex 1\n") + kPLYVertex, "1 2 3\n"), "PLY format = zip"},
      {"no_vertex.ply", ply("ascii", "element face 0\n", ""), "has no element vertex"},
      {"no_z.ply", ply("ascii", "element vertex 1\nproperty float x\nproperty float y\n", "1 2\n"),
       "vertex property z"},
      {"two_billion.ply", ply("binary_little_endian", std::string("element vertex 2000000000\n") + kPLYVertex, raw),
       "but only 12 bytes"},
      {"twice.ply", ply("ascii", std::string("element vertex 1\n") + kPLYVertex + "property float x\n", "1 2 3 4\n"),
       "property x of vertex stands twice"},
      {"two_elements.ply",
       ply("ascii", std::string("element vertex 1\n") + kPLYVertex + "element vertex 1\n" + kPLYVertex,
           "1 2 3\n4 5 6\n"),
       "element vertex stands twice"},
      {"cut_ascii.ply", ply("ascii", std::string("element vertex 2\n") + kPLYVertex, "1 2 3\n4.5555555 5\n"),
       "is missing"},
      {"list.ply",
       ply("binary_little_endian",
           std::string("element vertex 1\n") + kPLYVertex + "element face 1\nproperty list uint int vertex_indices\n",
           raw + "\xff\xff\xff\xff" + raw),
       "a corner of face 0 = 16843009"},
      {"empty.off", "", "is empty"},
      {"garbage.off", "solid cube\n", "does not begin with OFF"},
      {"cut.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n", "x of vertex 3 is missing"},
      {"face.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "corner of face 0 is missing"},
      {"index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "corner of face 0 = 3, must be <= 2"},
      {"letters.off", "OFF\n3 1 0\n0 zero 0\n1 0 0\n0 1 0\n3 0 1 2\n", "y of vertex 0 = zero, must be a number"},
      {"huge.off", "OFF\n2000000000 1 0\n0 0 0\n", "too short"},
      {"garbage.obj", std::string("\x7f\x45\0\1\2\3\xff\xfe", 8), "cannot be read"},
      {"empty.obj", "", "is empty"},
      {"letters.obj", "v 0 0 0\nv 1 zero 0\n", "y of vertex 1 = zero, must be a number"},
      {"garbage.stl", std::string("\x7f\x45\0\1\2\3\xff\xfe", 8), "cannot be read"},
      {"cut.stl", std::string(80, ' ') + std::string("\xff\xff\xff\x7f", 4) + raw, "cannot be read"},
      {"garbage.glb", std::string("\x7f\x45\0\1\2\3\xff\xfe", 8), "cannot be read"},
      {"cut.glb", std::string("glTF\2\0\0\0\xff\xff\0\0", 12), "cannot be read"},
      {"unknown.abc", "1 2 3\n", "unknown extension '.abc', must be .pcd"},
      {"none", "1 2 3\n", "unknown extension ''"}};
  const TemporaryFolder folder;
  for (const BadFile& file : files) {
    const std::string message = complaintOnReading(folder.write(file.name, file.content));
    EXPECT_NE(message.find(file.complaint), std::string::npos) << file.name << ": " << message;
  }
}

TEST(LoadShape, RefusesWhatIsNoReadableFile) {
  const TemporaryFolder folder;
  EXPECT_NE(complaintOnReading(folder / "missing.pcd").find("no such file"), std::string::npos);
  boost::filesystem::create_directory(folder / "directory.pcd");
  EXPECT_NE(complaintOnReading(folder / "directory.pcd").find("is a directory"), std::string::npos);
  if (geteuid() == 0) return;
  chmod(folder.write("locked.pcd", "x").c_str(), 0);
  EXPECT_NE(complaintOnReading(folder / "locked.pcd").find("cannot be opened"), std::string::npos);
}

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

TEST(LoadShape, ReadsMeshesOfEveryKind) {
  const TemporaryFolder folder;
  const std::string square = "0 0 0\n2 0 0\n2 1 0\n0 1 0\n";
  folder.write("plain.off", "OFF\n4 2 0\n" + square + "3 0 1 2\n4 0 1 2 3\n");
  folder.write("same_line.off", "OFF 4 2 0\n# comment\n" + square + "3 0 1 2 255 0 0\n4 0 1 2 3\n");
  folder.write("glued.OFF", "OFF4 2 0\n" + square + "3 0 1 2\n4 0 1 2 3\n2 0 1\n"),
      folder.write("color.off",
                   "COFF\n4 2 0\n0 0 0 9 9 9 9\n2 0 0 9 9 9 9\n2 1 0 9 9 9 9\n0 1 0 9 9 9 9\n3 0 1 2\n4 0 1 2 3\n");
  folder.write("text.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3\nf 1 2 3 4\n");
  folder.write("text.ply", ply("ascii",
                               std::string("element vertex 4\n") + kPLYVertex +
                                   "element face 2\nproperty list uchar int vertex_indices\n",
                               square + "3 0 1 2\n4 0 1 2 3\n"));
  for (const char* name : {"plain.off", "same_line.off", "glued.OFF", "color.off", "text.obj", "text.ply"}) {
    const Shape shape = loadShape(folder / name);
    ASSERT_TRUE(shape.mesh) << name;
    EXPECT_EQ(shape.points->size(), 4u) << name;
    ASSERT_EQ(shape.mesh->polygons.size(), 2u) << name;
    EXPECT_EQ(shape.mesh->polygons[0].vertices.size(), 3u) << name;
    EXPECT_EQ(shape.mesh->polygons[1].vertices.size(), 4u) << name;
    const auto& corner = (*shape.points)[static_cast<std::size_t>(shape.mesh->polygons[1].vertices[2])];
    EXPECT_EQ(corner.getVector3fMap(), Eigen::Vector3f(2, 1, 0)) << name;
  }
}

TEST(LoadShape, JoinsTheRepeatedCornersOfSTL) {
  const TemporaryFolder folder;
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 1\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
  };
  folder.write("square.stl",
               "solid s\n" + facet("0 0 0", "2 0 0", "2 1 0") + facet("0 0 0", "2 1 0", "0 1 0") + "endsolid s\n");
  const Shape shape = loadShape(folder / "square.stl");
  EXPECT_EQ(shape.points->size(), 4u);
  EXPECT_EQ(shape.mesh->polygons.size(), 2u);
}

TEST(LoadShape, ReadsThePointsOfRangeGrids) {
  const TemporaryFolder folder;
  const std::string info = "obj_info num_cols 3\nobj_info num_rows 1\n";
  const std::string grid = "element range_grid 3\nproperty list uchar int vertex_indices\n";
  const std::string text = ply("ascii", info + "element vertex 2\n" + kPLYVertex + grid, "1 2 3\n4 5 6\n1 0\n0\n1 1\n");
  const Shape shape = loadShape(folder.write("grid.ply", text));
  ASSERT_EQ(shape.points->size(), 2u);
  EXPECT_EQ((*shape.points)[1].x, 4.0f);
}

TEST(LoadShape, ShiftsNothingWhereTheExtentIsNoNormalNumber) {
  const TemporaryFolder folder;
  for (const std::string x : {"1e300", "0", "1"}) {
    const std::string points = x + " 0 0\n" + x + " 5e-324 0\n";
    const Shape shape =
        loadShape(folder.write("tiny.pcd", pcd("x y z", "8 8 8", "F F F", 2, 1, 2, "ascii\n" + points)));
    EXPECT_TRUE(shape.shift.isZero(0.0)) << x;
    EXPECT_EQ(shape.points->size(), 2u);
  }
}

TEST(LoadShape, ReadsPointsOfColumnsAndOfFilesWithoutFaces) {
  const TemporaryFolder folder;
  folder.write("a.xyz", "# x y z red\n0 0 0 255\n\n2 1 0.5 0 0\n");
  folder.write("a.obj", "# points\nv 0 0 0\n  v 2 1 0.5\n");
  folder.write("a.off", "OFF\n2 0 0\n0 0 0\n2 1 0.5\n");
  for (const char* name : {"a.xyz", "a.obj", "a.off"}) {
    const Shape shape = loadShape(folder / name);
    EXPECT_FALSE(shape.mesh) << name;
    ASSERT_EQ(shape.points->size(), 2u) << name;
    EXPECT_EQ((*shape.points)[1].getVector3fMap(), Eigen::Vector3f(2, 1, 0.5f)) << name;
    EXPECT_TRUE(shape.shift.isZero(0.0)) << name;
  }
}

TEST(LoadShape, ReadsBinaryGlTF) {
  const TemporaryFolder folder;
  const float corners[9] = {0, 0, 0, 2, 0, 0, 2, 1, 0};
  const std::string values(reinterpret_cast<const char*>(corners), sizeof(corners));
  const Shape mesh = loadShape(folder.write("mesh.glb", glb(R"({"attributes":{"POSITION":0},"mode":4})", values)));
  ASSERT_TRUE(mesh.mesh);
  EXPECT_EQ(mesh.mesh->polygons.size(), 1u);
  EXPECT_EQ(mesh.points->at(2).getVector3fMap(), Eigen::Vector3f(2, 1, 5)) << "in the frame of the scene";
  const Shape points = loadShape(folder.write("points.glb", glb(R"({"attributes":{"POSITION":0},"mode":0})", values)));
  EXPECT_FALSE(points.mesh);
  ASSERT_EQ(points.points->size(), 3u);
  EXPECT_EQ(points.points->at(1).getVector3fMap(), Eigen::Vector3f(2, 0, 5));
  const Shape fan = loadShape(folder.write("fan.glb", glb(R"({"attributes":{"POSITION":0},"mode":6})", values)));
  ASSERT_TRUE(fan.mesh);
  EXPECT_EQ(fan.mesh->polygons.size(), 1u);
}

/// A scene is a tree, and counts are those of the file: nothing is read in circles or beyond the end.
TEST(LoadShape, RefusesGlTFThatPromisesTooMuch) {
  const TemporaryFolder folder;
  const float corners[9] = {0, 0, 0, 2, 0, 0, 2, 1, 0};
  const std::string values(reinterpret_cast<const char*>(corners), sizeof(corners));
  const std::string triangle = R"({"attributes":{"POSITION":0},"mode":4})";
  const std::string whole = glb(triangle, values);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to + std::string(from.size() - to.size(), ' '));
    return complaintOnReading(folder.write("a.glb", text));
  };
  const std::vector<std::array<std::string, 3>> changes = {
      {R"("count":3)", R"("count":4)", "accessors[0]"},
      {R"({"asset":)", R"(x"asset":)", "cannot be read as glb"},
      {R"("buffer":0,"byteOffset":0,)", R"("buffer":0,"byteOffset":9,)", "out of range"},
      {R"("translation":[0,0,5])", R"("children":[0])", "recursive reference"},
      {R"("mesh":0)", R"("mesh":7)", "out of bounds"},
      {R"("componentType":5126)", R"("componentType":5127)", "Unsupported Component Type"},
      {R"({"bufferView":0,"componentType":5126,)", R"({"componentType":5126,)", "accessors[0]"}};
  for (const auto& [from, to, said] : changes) EXPECT_NE(changed(from, to).find(said), std::string::npos) << from;
  std::string quantized = whole;
  quantized.replace(quantized.find(R"("scene":0)"), 9, R"("e":"KHR_mesh_quantization")");
  EXPECT_NE(complaintOnReading(folder.write("a.glb", quantized)).find("is compressed by KHR_mesh_quantization"),
            std::string::npos);
}

/// Map coordinates of a square of one metre, which float cannot tell apart: its spacing there is half a metre.
TEST(LoadShape, ShiftsCoordinatesThatFloatCannotHold) {
  const TemporaryFolder folder;
  const std::string a = "500000.25 5000000.125 100", b = "500001.25 5000000.125 100", c = "500001.25 5000001.125 100";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  folder.write("a.off", "OFF\n3 1 0\n" + a + "\n" + b + "\n" + c + "\n3 0 1 2\n");
  folder.write("a.obj", "v " + a + "\nv " + b + "\nv " + c + "\nf 1 2 3\n");
  folder.write("a.xyz", a + "\n" + b + "\n" + c + "\n");
  folder.write("a.pcd", pcd("x y z", "8 8 8", "F F F", 3, 1, 3, "ascii\n" + a + "\n" + b + "\n" + c + "\n"));
  folder.write("a.ply",
               ply("ascii", "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + faces,
                   a + "\n" + b + "\n" + c + "\n3 0 1 2\n"));
  for (const char* name : {"a.off", "a.obj", "a.xyz", "a.pcd", "a.ply"}) {
    const Shape shape = loadShape(folder / name);
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
  const Shape near = loadShape(folder.write("near.off", "OFF\n3 1 0\n7 7 7\n8 7 7\n8 8 7\n3 0 1 2\n"));
  EXPECT_TRUE(near.shift.isZero(0.0)) << "float is precise enough";
}

}  // namespace
