#include <pcl/common/io.h>
#include <zlib.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "io/answers.h"
#include "io/cloud_file.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/load_module.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

namespace {

namespace fs = boost::filesystem;
using Fields = std::map<std::string, std::string>;
using Eigen::Matrix3d, Eigen::Vector3d;

/// The voxels of a file, the first index fastest, as its header describes them.
struct Voxels {
  std::string file;             ///< name of the file with the voxels; empty: the file of the header
  std::uint64_t begin = 0;      ///< bytes of the file before the data
  std::uint64_t num_lines = 0;  ///< number of lines before the data, after these bytes
  bool is_packed = false;       ///< whether the data are compressed, by zlib or gzip
  std::uint64_t skipped = 0;    ///< bytes of the data before the voxels
  bool is_at_end = false;       ///< whether the voxels are the last bytes of the data
  bool has_more = false;        ///< whether other things may follow the voxels
  bool is_big = false;          ///< whether the highest byte comes first
  std::uint8_t type = 0;        ///< type of a value, of pcl::PCLPointField
  double components = 1.0;      ///< number of values of a voxel, of which the first is used
  double num_volumes = 1.0;     ///< number of volumes, of which the first is used
  std::vector<double> sizes;
  Eigen::Affine3d T_input_index = Eigen::Affine3d::Identity();
  float slope = 1.0f, intercept = 0.0f;
};

[[noreturn]] void unreadable(const std::string& path, const std::string& why) {
  reject(path, "cannot be read, " + why);
}

/// \return the uncompressed bytes of a stream of zlib or of several of gzip, at most \p max_size.
std::string inflated(const std::string& path, std::string_view packed, std::uint64_t max_size) {
  z_stream stream{};
  constexpr int kZlibOrGzip = 15 + 32;
  std::string bytes;
  int state = inflateInit2(&stream, kZlibOrGzip);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  while (state == Z_OK && bytes.size() < max_size) {
    const std::size_t size = bytes.size(),
                      room = std::min<std::size_t>(max_size - size, std::max<std::size_t>(size, 4096));
    bytes.resize(size + room);
    stream.next_out = reinterpret_cast<Bytef*>(&bytes[size]);
    stream.avail_out = static_cast<uInt>(std::min<std::size_t>(room, 1u << 30));
    const uInt before = stream.avail_out;
    state = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(size + before - stream.avail_out);
    if (state == Z_STREAM_END && stream.avail_in > 2 && stream.next_in[0] == 0x1f) state = inflateReset(&stream);
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END && bytes.size() < max_size) unreadable(path, "its compressed data are damaged or cut off");
  return bytes;
}

/// The values of a binary header, by their byte offsets.
struct BinaryHeader {
  std::string_view bytes;
  bool is_big;

  template <typename Value>
  double at(std::size_t position) const {
    char value[sizeof(Value)];
    std::memcpy(value, &bytes[position], sizeof(Value));
    if (is_big) std::reverse(std::begin(value), std::end(value));
    Value number;
    std::memcpy(&number, value, sizeof(Value));
    return static_cast<double>(number);
  }
  template <typename Value>
  Vector3d vectorAt(std::size_t position, std::size_t step = sizeof(Value)) const {
    return {at<Value>(position), at<Value>(position + step), at<Value>(position + 2 * step)};
  }
};

/// The frame of NIfTI: its affine map, otherwise its rotation and reflection, otherwise the spacing of Analyze.
/// \param codes if sform_code is not 0, the map is valid; if qform_code is not 0, the rotation is.
template <typename Real>
Eigen::Affine3d niftiFrame(const BinaryHeader& header, const bool (&codes)[2], std::size_t at_spacing,
                           std::size_t at_quaternion, std::size_t at_rows) {
  constexpr std::size_t kSize = sizeof(Real);
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
  if (codes[0]) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        frame(row, column) = header.at<Real>(at_rows + (4 * row + column) * kSize);
    return frame;
  }
  Vector3d spacing = header.vectorAt<Real>(at_spacing + kSize).cwiseAbs();
  for (double& length : spacing)
    if (length == 0.0) length = 1.0;
  frame.linear() = spacing.asDiagonal();
  if (!codes[1]) return frame;
  const Vector3d bcd = header.vectorAt<Real>(at_quaternion);
  const double a = std::sqrt(std::max(0.0, 1.0 - bcd.squaredNorm()));
  Matrix3d turn = Eigen::Quaterniond(a, bcd.x(), bcd.y(), bcd.z()).normalized().toRotationMatrix();
  if (header.at<Real>(at_spacing) < 0.0) turn.col(2) *= -1.0;
  frame.linear() = turn * spacing.asDiagonal();
  frame.translation() = header.vectorAt<Real>(at_quaternion + 3 * kSize);
  return frame;
}

/// NIfTI 1 and 2, and Analyze 7.5, whose voxels are in a separate file.
Voxels niftiVoxels(const std::string& path, std::string_view bytes) {
  const auto isSize = [&](std::int32_t size, bool is_big) {
    return bytes.size() >= static_cast<std::size_t>(size) && BinaryHeader{bytes, is_big}.at<std::int32_t>(0) == size;
  };
  const bool is_big = isSize(348, true) || isSize(540, true), is_first = isSize(348, is_big);
  if (!is_first && !isSize(540, is_big)) unreadable(path, "it has no header of NIfTI");
  const BinaryHeader header{bytes, is_big};
  const std::string_view magic = bytes.substr(is_first ? 344 : 4, 3);
  const bool is_apart = magic.substr(0, 2) != "n+";
  if (is_apart && magic.substr(0, 2) != "ni" && !boost::algorithm::iends_with(path, "hdr"))
    unreadable(path, "it has no header of NIfTI");
  // By the code in the header: type, number of values of a voxel.
  static const std::map<int, std::pair<std::uint8_t, double>> types = {
      {2, {pcl::PCLPointField::UINT8, 1.0}},      {4, {pcl::PCLPointField::INT16, 1.0}},
      {8, {pcl::PCLPointField::INT32, 1.0}},      {16, {pcl::PCLPointField::FLOAT32, 1.0}},
      {32, {pcl::PCLPointField::FLOAT32, 2.0}},   {64, {pcl::PCLPointField::FLOAT64, 1.0}},
      {128, {pcl::PCLPointField::UINT8, 3.0}},    {256, {pcl::PCLPointField::INT8, 1.0}},
      {512, {pcl::PCLPointField::UINT16, 1.0}},   {768, {pcl::PCLPointField::UINT32, 1.0}},
      {1024, {pcl::PCLPointField::INT64, 1.0}},   {1280, {pcl::PCLPointField::UINT64, 1.0}},
      {1792, {pcl::PCLPointField::FLOAT64, 2.0}}, {2304, {pcl::PCLPointField::UINT8, 4.0}}};
  const int code = static_cast<int>(header.at<std::int16_t>(is_first ? 70 : 12));
  const auto type = types.find(code);
  if (type == types.end()) unreadable(path, "its voxels are of the unknown type " + std::to_string(code));
  const auto sizeAt = [&](int k) {
    return is_first ? header.at<std::int16_t>(40 + 2 * k) : header.at<std::int64_t>(16 + 8 * k);
  };
  Voxels voxels;
  std::tie(voxels.type, voxels.components) = type->second;
  voxels.is_big = is_big;
  const double num_sizes = sizeAt(0);
  for (int k = 1; k <= 7; ++k) {
    const double size = k <= num_sizes ? sizeAt(k) : 1.0;
    if (k <= 3) voxels.sizes.push_back(size);
    if (k > 3) voxels.num_volumes *= std::max(1.0, size);
  }
  const double begin = is_first ? header.at<float>(108) : header.at<std::int64_t>(168);
  if (!(begin >= 0.0 && begin < 1e9) || !(num_sizes >= 1.0 && num_sizes <= 7.0))
    unreadable(path, "its header is not of NIfTI");
  voxels.skipped = static_cast<std::uint64_t>(std::max(begin, is_apart ? 0.0 : is_first ? 348.0 : 540.0));
  if (is_apart) {
    const fs::path pixels = fs::path(path).replace_extension("img");
    voxels.is_packed = !fs::exists(pixels) && fs::exists(pixels.string() + ".gz");
    voxels.file = pixels.filename().string() + (voxels.is_packed ? ".gz" : "");
  }
  const double slope = is_first ? header.at<float>(112) : header.at<double>(176);
  if (magic[0] == 'n' && std::isfinite(slope) && slope != 0.0) {
    voxels.slope = static_cast<float>(slope);
    voxels.intercept = static_cast<float>(is_first ? header.at<float>(116) : header.at<double>(184));
  }
  const auto codeAt = [&](std::size_t first, std::size_t second) {
    return magic[0] == 'n' && (is_first ? header.at<std::int16_t>(first) : header.at<std::int32_t>(second)) > 0.0;
  };
  const bool codes[] = {codeAt(254, 348), codeAt(252, 344)};
  voxels.T_input_index =
      is_first ? niftiFrame<float>(header, codes, 76, 256, 280) : niftiFrame<double>(header, codes, 104, 352, 400);
  return voxels;
}

/// The files of FreeSurfer.
Voxels mghVoxels(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kVoxels = 284;
  const BinaryHeader header{bytes, true};
  static const std::map<int, std::uint8_t> types = {{0, pcl::PCLPointField::UINT8},
                                                    {1, pcl::PCLPointField::INT32},
                                                    {3, pcl::PCLPointField::FLOAT32},
                                                    {4, pcl::PCLPointField::INT16},
                                                    {10, pcl::PCLPointField::UINT16}};
  if (bytes.size() < kVoxels || header.at<std::int32_t>(0) != 1.0) unreadable(path, "it has no header of MGH");
  const auto type = types.find(static_cast<int>(header.at<std::int32_t>(20)));
  if (type == types.end()) unreadable(path, "its voxels are of an unknown type");
  Voxels voxels;
  voxels.skipped = kVoxels;
  voxels.is_big = voxels.has_more = true;
  voxels.type = type->second;
  const Vector3d sizes = header.vectorAt<std::int32_t>(4);
  voxels.sizes = {sizes.x(), sizes.y(), sizes.z()};
  voxels.num_volumes = std::max(1.0, header.at<std::int32_t>(16));
  Vector3d spacing = Vector3d::Ones(), center = Vector3d::Zero();
  Matrix3d direction;
  direction << -1, 0, 0, 0, 0, 1, 0, -1, 0;  // the default for headers without directions
  if (header.at<std::int16_t>(28) > 0.0) {
    spacing = header.vectorAt<float>(30);
    center = header.vectorAt<float>(78);
    for (int k = 0; k < 3; ++k) direction.col(k) = header.vectorAt<float>(42 + 12 * k);
  }
  voxels.T_input_index.linear() = direction * spacing.asDiagonal();
  voxels.T_input_index.translation() = center - voxels.T_input_index.linear() * sizes / 2.0;
  return voxels;
}

/// The fields of the header of NRRD or MetaImage, and where the bytes behind it begin.
Fields fieldsOf(const std::string& path, std::string_view text, bool is_nrrd, std::uint64_t& end) {
  const std::string sign = is_nrrd ? ": " : "=";
  Fields fields;
  LineReader lines(text);
  std::string_view line;
  bool is_whole = !is_nrrd || (lines.next(line) && line.substr(0, 4) == "NRRD" && isPrintable(line));
  if (!is_whole) unreadable(path, "it does not begin with NRRD");
  while (is_whole && lines.next(line)) {
    end = lines.position();
    if (is_nrrd && line.empty()) return fields;
    const std::size_t at = line.find(sign);
    is_whole = isPrintable(line);
    if (is_nrrd && (line[0] == '#' || (at == std::string::npos && line.find(":=") < line.size()))) continue;
    is_whole = is_whole && at != std::string::npos;
    if (!is_whole) break;
    const std::string key = boost::algorithm::trim_copy(std::string(line.substr(0, at)));
    const std::string value = boost::algorithm::trim_copy(std::string(line.substr(at + sign.size())));
    is_whole = !value.empty() && fields.emplace(key, value).second && (key != "sizes" || fields.count("dimension"));
    if (is_whole && key == "ElementDataFile") return fields;
  }
  // A header in a file of its own may end with that file.
  if (is_whole && is_nrrd && (fields.count("data file") || fields.count("datafile"))) return fields;
  unreadable(path, "a line of its header is no field with a value");
}

/// \return the value of the first key that exists; empty if none does.
std::string valueOf(const Fields& fields, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (const auto found = fields.find(key); found != fields.end()) return found->second;
  return {};
}

/// The numbers in a text, whatever separates them.
std::vector<double> numbersIn(std::string text) {
  std::replace_if(text.begin(), text.end(), boost::algorithm::is_any_of("(),;"), ' ');
  std::vector<double> numbers;
  double number = 0.0;
  for (const std::string& word : split(text))
    if (spellsNumber(word, &number)) numbers.push_back(number);
  return numbers;
}

/// \param columns columns of T_input_index, nine numbers; if they are empty, the three numbers of the spacing are used.
Eigen::Affine3d frameOf(const std::string& path, std::vector<double> columns, const std::vector<double>& spacing,
                        const std::vector<double>& origin) {
  if (columns.size() < 9) columns = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
  frame.linear() = Eigen::Map<const Matrix3d>(columns.data());
  if (spacing.size() >= 3) frame.linear() *= Eigen::Map<const Vector3d>(spacing.data()).cwiseAbs().asDiagonal();
  if (origin.size() >= 3) frame.translation() = Eigen::Map<const Vector3d>(origin.data());
  if (!frame.matrix().allFinite()) unreadable(path, "its frame is not finite");
  return frame;
}

/// \return number of skipped bytes; -1 in the header means all bytes before the voxels.
std::uint64_t skipOf(const std::string& path, const std::string& value, Voxels& voxels) {
  std::uint64_t skip = 0;
  voxels.is_at_end |= value == "-1";
  if (value != "-1" && !value.empty() && (!spellsCount(value, &skip) || skip > kMaxPoints))
    unreadable(path, "what it skips = " + value.substr(0, 40) + ", must be a whole number >= -1");
  return skip;
}

void checkOneFile(const std::string& path, const std::string& file) {
  if (file.find('%') != std::string::npos || file.substr(0, 4) == "LIST")
    unreadable(path, "its data must be in one file");
}

std::uint8_t typeOf(const std::string& path, const std::string& name) {
  const std::optional<std::uint8_t> type = typeNamed(name);
  if (!type) unreadable(path, "its voxels are of the unknown type " + name.substr(0, 40));
  return *type;
}

Voxels nrrdVoxels(const std::string& path, std::string_view text) {
  Voxels voxels;
  std::uint64_t end = 0;
  const Fields fields = fieldsOf(path, text, true, end);
  const auto value = [&](std::initializer_list<const char*> keys) { return valueOf(fields, keys); };
  const std::string sizes = value({"sizes"}), encoding = value({"encoding"}), space = value({"space dimension"});
  voxels.sizes = numbersIn(sizes);
  if (!boost::algorithm::all(sizes, boost::is_digit() || boost::is_space()) || voxels.sizes.size() != 3 ||
      value({"dimension"}) != "3" || value({"type"}).empty() || (!space.empty() && space != "3"))
    unreadable(path, "its header must have type, dimension 3 and three sizes");
  voxels.is_packed = encoding == "gzip" || encoding == "gz";
  if (encoding != "raw" && !voxels.is_packed) reject(path, "encoding = " + encoding + ", must be raw or gzip");
  voxels.type = typeOf(path, value({"type"}));
  voxels.is_big = value({"endian"}) == "big";
  voxels.file = value({"data file", "datafile"});
  checkOneFile(path, voxels.file);
  if (voxels.file.empty()) voxels.begin = end;
  voxels.num_lines = skipOf(path, value({"line skip", "lineskip"}), voxels);
  voxels.skipped = skipOf(path, value({"byte skip", "byteskip"}), voxels);
  voxels.T_input_index = frameOf(path, numbersIn(value({"space directions"})),
                                 numbersIn(fields.count("space directions") ? "" : value({"spacings"})),
                                 numbersIn(value({"space origin"})));
  return voxels;
}

Voxels metaVoxels(const std::string& path, std::string_view text) {
  Voxels voxels;
  std::uint64_t end = 0;
  const Fields fields = fieldsOf(path, text, false, end);
  const auto value = [&](std::initializer_list<const char*> keys) { return valueOf(fields, keys); };
  const auto isTrue = [&](std::initializer_list<const char*> keys) { return value(keys).find_first_of("TtYy1") == 0; };
  voxels.sizes = numbersIn(value({"DimSize"}));
  if (value({"NDims"}) != "3" || voxels.sizes.size() != 3)
    unreadable(path, "NDims must be 3, with three numbers of DimSize");
  voxels.file = value({"ElementDataFile"});
  checkOneFile(path, voxels.file);
  if (fields.count("BinaryData") && !isTrue({"BinaryData"})) reject(path, "BinaryData = False, must be True");
  voxels.is_big = isTrue({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"});
  voxels.is_packed = isTrue({"CompressedData"});
  voxels.type = typeOf(path, value({"ElementType"}));
  for (const double channels : numbersIn(value({"ElementNumberOfChannels"}))) voxels.components = channels;
  const bool is_apart = voxels.file != "LOCAL" && voxels.file != "Local" && voxels.file != "local";
  if (!is_apart) voxels.file.clear();
  voxels.begin = is_apart ? skipOf(path, value({"HeaderSize"}), voxels) : end;
  for (const double size : numbersIn(value({"CompressedDataSize"})))
    if (!(size > 0.0) || (!is_apart && size > static_cast<double>(text.size() - end)))
      unreadable(path, "its header does not fit its data: CompressedDataSize = " + value({"CompressedDataSize"}));
  std::vector<double> columns = numbersIn(value({"TransformMatrix", "Orientation", "Rotation"}));
  voxels.T_input_index = frameOf(path, columns, numbersIn(value({"ElementSpacing", "ElementSize"})),
                                 numbersIn(value({"Offset", "Position", "Origin"})));
  return voxels;
}

/// \return the bytes of the voxels, at least of the first volume.
/// \param unpacked holds the bytes if they are compressed.
std::string_view bytesOf(const std::string& path, const Voxels& voxels, std::string_view data, std::string& unpacked) {
  double num_voxels = voxels.num_volumes, slice = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double size = voxels.sizes[k];
    if (!(size >= 1.0 && size <= kMaxPoints) || size != std::floor(size))
      unreadable(path, formatted("its size along an axis = %g, must be a whole number >= 1", size));
    num_voxels *= size;
    slice *= k < 2 ? size : 1.0;
  }
  const double voxel = voxels.components * pcl::getFieldSize(voxels.type), all = num_voxels * voxel;
  if (!(voxels.components >= 1.0 && voxels.components <= 64.0) || all > 1e15) unreadable(path, "it is too large");
  const auto cutAt = [&](std::uint64_t begin) {
    if (begin > data.size()) unreadable(path, "it is cut off before its voxels");
    data.remove_prefix(begin);
  };
  cutAt(voxels.begin);
  for (std::uint64_t k = 0; k < voxels.num_lines; ++k) cutAt(std::min(data.find('\n'), data.size()) + 1);
  const bool is_one = voxels.num_volumes == 1.0;
  const double needed = is_one || !voxels.is_packed ? all : all / voxels.num_volumes;
  if (voxels.is_packed)
    data = unpacked = inflated(path, data, voxels.skipped + static_cast<std::uint64_t>(needed) + (is_one ? 1 : 0));
  if (voxels.is_at_end && static_cast<double>(data.size()) > all) cutAt(data.size() - static_cast<std::uint64_t>(all));
  if (!voxels.is_at_end) cutAt(voxels.skipped);
  const auto size = static_cast<double>(data.size());
  if (size < needed && voxels.is_packed) unreadable(path, "its data hold fewer voxels than its header says");
  slice *= voxel;
  if (size < needed && size >= slice && std::fmod(size, slice) == 0.0)
    unreadable(path, formatted("its header does not fit its data: %.0f slices, the header says %.0f", size / slice,
                               needed / slice));
  if (size < needed) unreadable(path, formatted("it is cut off: %.0f of %.0f bytes of voxels", size, needed));
  if (size > needed && !voxels.has_more)
    unreadable(path, formatted("its header does not fit its data: more than the %.0f bytes of its voxels", needed));
  return data;
}

Volume volumeOf(const std::string& path) {
  const auto ends = [&](const char* ending) { return boost::algorithm::iends_with(path, ending); };
  const std::string header = ends(".img") ? fs::path(path).replace_extension("hdr").string() : path;
  std::string text = readWholeFile(header), unpacked;
  Voxels voxels;
  if (ends(".nrrd") || ends(".nhdr") || ends(".mha") || ends(".mhd")) {
    if (ends("hdr") || ends("mhd")) text = withoutMark(std::move(text));
    voxels = ends("hdr") || ends("nrrd") ? nrrdVoxels(path, text) : metaVoxels(path, text);
  } else {
    const bool is_packed = ends("gz");
    constexpr std::uint64_t kMostHeader = 540;
    const std::string begin = is_packed ? inflated(path, text, kMostHeader) : text.substr(0, kMostHeader);
    voxels = ends(".mgh") || ends(".mgz") ? mghVoxels(path, begin) : niftiVoxels(header, begin);
    voxels.is_packed |= is_packed;
  }
  if (!voxels.file.empty()) text = readWholeFile((fs::path(path).parent_path() / voxels.file).string());
  const std::string_view bytes = bytesOf(path, voxels, text, unpacked);
  ScalarGrid::Size size;
  for (int k = 0; k < 3; ++k) size[k] = static_cast<int>(voxels.sizes[k]);
  std::vector<float> values(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
  withType(voxels.type, [&](auto value) {
    const std::size_t step = sizeof(value) * static_cast<std::size_t>(voxels.components);
    for (std::size_t i = 0; i < values.size(); ++i) {
      char raw[sizeof(value)];
      std::memcpy(raw, &bytes[i * step], sizeof(value));
      if (voxels.is_big) std::reverse(std::begin(raw), std::end(raw));
      std::memcpy(&value, raw, sizeof(value));
      values[i] = voxels.slope * static_cast<float>(value) + voxels.intercept;
    }
    return 0;
  });
  Volume volume;
  const auto leaveOut = [&](double number, const char* what) {
    if (number > 1.0) volume.left_out.push_back(formatted("%.0f more ", number - 1.0) + what);
  };
  leaveOut(voxels.components, "values a voxel");
  leaveOut(voxels.num_volumes, "volumes");
  volume.grid = std::make_shared<ScalarGrid>(size, voxels.T_input_index, std::move(values));
  return volume;
}

}  // namespace

bool isVolumePath(const std::string& path) {
  for (const char* ending :
       {".nii", ".nii.gz", ".hdr", ".img", ".mgh", ".mgz", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti"})
    if (boost::algorithm::iends_with(path, ending)) return true;
  return false;
}

Volume loadVolume(const std::string& path) {
  const auto load = [&] {
    if (!boost::algorithm::iends_with(path, ".vti")) return volumeOf(path);
    Volume volume;
    functionOf<decltype(readVTI)>(kDrawingModule, "readVTI")(path, volume);
    return volume;
  };
  return namingFile(path, load, "cannot be read, ");
}

}  // namespace pcl_symmetry::apps
