/// CT and MR volumes as files: the same plane from every format, and a sentence for bad ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/input_shape.h"
#include "pictures/raster_image.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

constexpr int kSize[3] = {44, 48, 40};

/// A body with a pair of spots, symmetric in the plane x = 20.5 of the grid.
/// \param step every step-th slice.
std::vector<float> body(int step = 1) {
  std::vector<float> values;
  for (int z = 0; z < kSize[2]; z += step)
    for (int y = 0; y < kSize[1]; ++y)
      for (int x = 0; x < kSize[0]; ++x) {
        const double side = std::abs(x - 20.5), v = y - 23.0, w = z - 19.0;
        const double hull =
            std::sqrt(std::pow(side / 15, 2) + std::pow((v + 0.004 * w * w) / 19, 2) + std::pow(w / 16, 2));
        const double spot = std::hypot(side - 7, std::hypot(v - 8, w - 3));
        values.push_back(static_cast<float>(100.0 / (1.0 + std::exp((hull - 1) * 12)) +
                                            60.0 / (1.0 + std::exp(spot - 3)) +
                                            30.0 / (1.0 + std::exp(std::hypot(v - 15, w + 9) - 4))));
      }
  return values;
}

std::string bytesOf(const std::vector<float>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size());
}

/// Axes of the grid along y, -x and z of the frame, spacing 2, 2 and 3: the plane is y = 2 * 20.5 + 7.
std::string metaImage(const std::string& data, int slices = 40, int thickness = 3) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\n"
         "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 7 -9\nElementSpacing = 2 2 " +
         std::to_string(thickness) + "\nDimSize = 44 48 " + std::to_string(slices) +
         "\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n" + data;
}

std::string nrrd(const std::string& data, int slices = 40, int thickness = 3) {
  return "NRRD0004\ntype: float\ndimension: 3\nspace: left-posterior-superior\nsizes: 44 48 " + std::to_string(slices) +
         "\nendian: little\nencoding: raw\nspace directions: (0,2,0) (-2,0,0) (0,0," + std::to_string(thickness) +
         ")\nspace origin: (5,7,-9)\n\n" + data;
}

std::string nifti(const std::string& data, int slices = 40, int thickness = 3) {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto value) { std::memcpy(&header[at], &value, sizeof value); };
  put(0, std::int32_t{348});
  const std::int16_t dims[8] = {3, 44, 48, static_cast<std::int16_t>(slices), 1, 1, 1, 1};
  for (int i = 0; i < 8; ++i) put(40 + 2 * i, dims[i]);
  put(70, std::int16_t{16});  // float
  put(72, std::int16_t{32});
  const float depth = thickness, spacing[4] = {1, 2, 2, depth};
  for (int i = 0; i < 4; ++i) put(76 + 4 * i, spacing[i]);
  put(108, 352.0f);
  put(112, 2.0f);  // slope
  put(116, -50.0f);
  put(254, std::int16_t{1});  // sform
  const float rows[12] = {0, -2, 0, 5, 2, 0, 0, 7, 0, 0, depth, -9};
  for (int i = 0; i < 12; ++i) put(280 + 4 * i, rows[i]);
  std::memcpy(&header[344], "n+1", 4);
  return header + data;
}

std::string vti(const std::string& data, int slices = 40, int thickness = 3) {
  const std::string extent = "0 43 0 47 0 " + std::to_string(slices - 1);
  const auto size = static_cast<std::uint32_t>(data.size());
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
         "<ImageData WholeExtent=\"" +
         extent + "\" Origin=\"5 7 -9\" Spacing=\"2 2 " + std::to_string(thickness) +
         "\" Direction=\"0 -1 0 1 0 0 0 0 1\"><Piece Extent=\"" + extent +
         "\"><PointData Scalars=\"f\"><DataArray type=\"Float32\" Name=\"f\" format=\"appended\" offset=\"0\"/>"
         "</PointData></Piece></ImageData><AppendedData encoding=\"raw\">_" +
         std::string(reinterpret_cast<const char*>(&size), 4) + data + "</AppendedData></VTKFile>\n";
}

/// An ending and what writes it.
const std::pair<std::string, std::string (*)(const std::string&, int, int)> kFormats[] = {
    {".mha", metaImage}, {".nrrd", nrrd}, {".nii", nifti}, {".vti", vti}};

class MapsOfVolumes : public ToolTest {
protected:
  MapsOfVolumes() : ToolTest(toolPath("map")) {}
};

TEST_F(MapsOfVolumes, AreOfPlanesAxesAndCentersAndSeenAtAScale) {
  const std::string path = folder_.write("a.mha", metaImage(bytesOf(body())));
  for (const std::string flags :
       {"-method exact", "-method rotational", "-method voting -as_published", "-of axes -fold 2", "-of centers", "-scale 0.4"}) {
    const nlohmann::json report = reportOf(path + " -quiet -grid 16 " + flags);
    // No center lies at the border, where the values of the map are read.
    EXPECT_GT(flags == "-of centers" ? report["centers"][0]["symmetry"] : report["greatest"], 0.6) << flags;
    EXPECT_GT(report["num_points"], 500) << "the border of the body";
  }
}

class Volumes : public ToolTest {
protected:
  Volumes() : ToolTest(toolPath("planes")) {}

  nlohmann::json planesOf(const std::string& path, const std::string& flags = "") {
    return reportOf(path + " -quiet " + flags)["planes"];
  }
};

TEST_F(Volumes, OfAllFormatsHaveTheSamePlaneInTheFrameOfTheFile) {
  const std::string data = bytesOf(body()), one_in_ten = bytesOf(body(10));
  for (const auto& [ending, write] : kFormats)
    for (const std::string& path :
         {folder_.write("a" + ending, write(data, 40, 3)), folder_.write("thick" + ending, write(one_in_ten, 4, 20))}) {
      const nlohmann::json planes = planesOf(path);
      ASSERT_GE(planes.size(), 1u) << path;
      const double b = planes[0]["coefficients"][1], d = planes[0]["coefficients"][3];  // of either sign
      EXPECT_NEAR(std::abs(b), 1.0, 1e-4) << path;
      EXPECT_NEAR(d / b, -48.0, 0.05) << path;
      EXPECT_GT(planes[0]["confidence"], 0.8) << path;
    }
}

TEST_F(Volumes, KeepWhatTheirHeadersSay) {
  const Volume volume = loadVolume(folder_.write("a.nii", nifti(bytesOf(body()))));
  EXPECT_EQ(volume.grid->size()[1], 48);
  EXPECT_NEAR(volume.grid->values()[0], 2.0f * body()[0] - 50.0f, 1e-4);
  EXPECT_LT((volume.grid->T_input_index() * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(1, 9, 0)).norm(), 1e-6);
}

TEST_F(Volumes, AreDrawnAsSlicesAndTheirSurfaceIsAMesh) {
  const std::string path = folder_.write("a.mha", metaImage(bytesOf(body())));
  ASSERT_EQ(run(path + " -quiet -png " + (folder_ / "a.png")), 0) << error_;
  const RasterImage picture = readImage(folder_ / "a.png");
  EXPECT_GT(picture.width, 3 * 400);
  EXPECT_GT(picture.height, 2 * 400);
  const nlohmann::json of_surface = planesOf(path, "-surface 50");
  ASSERT_GE(of_surface.size(), 1u);
  EXPECT_NEAR(std::abs(double(of_surface[0]["coefficients"][3])), 48.0, 0.5);
  EXPECT_GE(planesOf(path, "-levels 20,120").size(), 1u);
}

TEST_F(Volumes, ThatAreBadGetASentence) {
  const std::string data = bytesOf(body());
  const std::vector<float> zero(body().size()), nan(body().size(), std::numeric_limits<float>::quiet_NaN());
  const std::array<std::string, 3> files[] = {
      {"cut.nii", nifti(data).substr(0, 90'000), "cut off"},
      {"cut.nrrd", nrrd(data).substr(0, 90'000), "cut.nrrd"},
      {"cut.mha", metaImage(data).substr(0, 90'000), "cut.mha"},
      {"text.nii.gz", "no volume", "text.nii.gz"},
      {"axes.mha", metaImage(data).replace(27, 1, "4"), "NDims must be 3"},
      {"type.nii", nifti(data).replace(70, 2, "\x39\x30"), "unknown type"},
      {"text.vti", "<VTKFile", "text.vti"},
      {"bare.nrrd", "NRRD0004\ntype: float\n\n" + data, "type, dimension"},
      {"sizes_8.nrrd", nrrd(data).replace(nrrd("").find("sizes:"), 6, "sizes 8:"), "type, dimension"},
      {"line.nrrd", "NRRD0004\ntype: short\ndimension: 1\nsizes: 810\nencoding: raw\n\n" + data, "dimension 3"},
      {"ends.nrrd", nrrd("").replace(nrrd("").size() - 1, 1, "\r\r\n"), "with a value"},
      {"words.nrrd", nrrd(data).replace(nrrd("").find("raw"), 3, "ascii"), "must be raw or gzip"},
      {"files.mha", "NDims = 3\nDimSize = 5 4 12\nElementType = MET_FLOAT\nElementDataFile = %a\n", "one file"},
      {"void.nrrd", "NRRD0004\ntype: float\nsizes: 9 9 9\ndimension: 3\n\n", "with a value"},
      {"zero.mha", metaImage(bytesOf(zero)), "equal"},
      {"nan.mha", metaImage(bytesOf(nan)), "finite"},
      {"one.mha", metaImage(data, "44 1920 1"), "slices"}};
  for (const auto& [name, content, said] : files) {
    EXPECT_TRUE(fails(folder_.write(name, content) + " -quiet", 1, said));
    EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  }
  EXPECT_TRUE(fails((folder_ / "missing.nii") + " -quiet", 1, "missing.nii"));
  EXPECT_EQ(run(folder_.write("a.mha", metaImage(data)) + " -levels 5,3"), 2);
}

}  // namespace
