/// The command line: flags, their help and errors, and many inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "command_line/command_line.h"
#include "command_line/input_files.h"
#include "command_line/run_on_files.h"
#include "command_line/tool_errors.h"
#include "io/shape_input.h"
#include "pcl_symmetry/core/detect_planes.h"
#include "shapes/complaint.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

struct BatchTest : testing::Test {
  BatchTest() {
    for (const char* name : {"a.xyz", "b.xyz", "c.xyz"}) folder.write(name, "1 2 3\n");
    common.quiet = true;
    common.json_path = folder / "out.jsonl";
    batch.inputs = {folder / "a.xyz", folder / "b.xyz", folder / "c.xyz"};
  }

  /// Fails for b, and is slow for a.
  int run() {
    return runOnFiles(batch, common, {"letter", "size"}, [this](FileJob& job) {
      ++num_analyzed;
      const std::string name = job.output("{}");
      if (name == "a") std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (name == failing) throw InputError(job.path() + ": is wrong");
      job.report({name + "\n", {{"file", job.path()}, {"letter", name}}, {{name, 7}, {name + ",", 0.5}}});
    });
  }

  std::vector<nlohmann::json> lines() const { return jsonLines(contentOf(folder / "out.jsonl")); }

  TemporaryFolder folder;
  BatchOptions batch;
  CommonOptions common;
  std::string failing;
  std::atomic<int> num_analyzed{0};
};

TEST_F(BatchTest, WritesALineForEachInputInTheirOrder) {
  batch.csv_path = folder / "out.csv";
  for (const int threads : {1, 3}) {
    common.threads = threads;
    ASSERT_EQ(run(), 0);
    ASSERT_EQ(lines().size(), 3u);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(lines()[i]["letter"], std::string(1, static_cast<char>('a' + i)));
    EXPECT_EQ(contentOf(folder / "out.csv"), "file,letter,size\n" + batch.inputs[0] + ",a,7\n" + batch.inputs[0] +
                                                 ",\"a,\",0.5\n" + batch.inputs[1] + ",b,7\n" + batch.inputs[1] +
                                                 ",\"b,\",0.5\n" + batch.inputs[2] + ",c,7\n" + batch.inputs[2] +
                                                 ",\"c,\",0.5\n");
  }
}

TEST_F(BatchTest, ResumesWhereItWasInterrupted) {
  failing = "b";
  batch.csv_path = folder / "out.csv";
  testing::internal::CaptureStderr();
  EXPECT_EQ(run(), 1);
  testing::internal::GetCapturedStderr();
  // Killed while it wrote the third line.
  const std::string whole = contentOf(folder / "out.jsonl");
  folder.write("out.jsonl", whole.substr(0, whole.size() - 4));
  failing.clear();
  num_analyzed = 0;
  batch.resume = true;
  ASSERT_EQ(run(), 0);
  EXPECT_EQ(num_analyzed, 2) << "b failed and c was torn";
  ASSERT_EQ(lines().size(), 3u);
  std::set<std::string> letters;
  for (const nlohmann::json& line : lines()) letters.insert(line.at("letter"));
  EXPECT_EQ(letters, (std::set<std::string>{"a", "b", "c"}));
  const std::string csv = contentOf(folder / "out.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  ASSERT_EQ(run(), 0);
  EXPECT_EQ(num_analyzed, 2) << "nothing is left to do";
  folder.write("out.jsonl", "{\"shapes\": []}\n");
  EXPECT_THROW(run(), InputError) << "something else is not overwritten";
  EXPECT_EQ(contentOf(folder / "out.jsonl"), "{\"shapes\": []}\n");
}

/// With more inputs than may wait for an early one, nothing hangs and the order is that of the inputs.
TEST_F(BatchTest, TakesManyInputs) {
  std::string list;
  for (int i = 0; i < 2000; ++i) list += (folder / (std::to_string(i) + ".xyz")) + "\n";
  batch.inputs = {"@" + folder.write("list", list)};
  common.threads = 4;
  for (const int kept : {0, 1500}) {
    batch.resume = kept > 0;
    num_analyzed = 0;
    if (kept > 0) {
      std::istringstream all(contentOf(folder / "out.jsonl"));
      std::string some, line;
      for (int i = 0; i < kept && std::getline(all, line); ++i) some += line + "\n";
      folder.write("out.jsonl", some);
    }
    ASSERT_EQ(run(), 0);
    EXPECT_EQ(num_analyzed, 2000 - kept);
    const auto found = lines();
    ASSERT_EQ(found.size(), 2000u);
    for (int i = 0; i < 2000; ++i) ASSERT_EQ(found[i]["letter"], std::to_string(i));
  }
}

TEST_F(BatchTest, RefusesNamesThatClash) {
  std::optional<std::string> picture = "picture.png";
  batch.outputs = {&picture};
  EXPECT_THROW(run(), UsageError) << "no {}";
  picture = "-";
  EXPECT_THROW(run(), UsageError);
  picture = "{}.png";
  EXPECT_EQ(run(), 0);
  batch.inputs.push_back(folder / "more/a.pcd");
  EXPECT_THROW(run(), InputError) << "two inputs are called a";
  batch.inputs = {folder / "a.xyz"};
  batch.resume = true;
  EXPECT_THROW(run(), UsageError) << "nothing to resume";
}

TEST(InputFiles, AreFilesFoldersPatternsAndLists) {
  const TemporaryFolder folder;
  for (const char* name : {"b.pcd", "a.PLY", "c.txt", "d.glb"}) folder.write(name, "x");
  const auto paths = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> names;
    for (const InputFile& file : inputFiles(arguments)) names.push_back(file.path);
    return names;
  };
  EXPECT_EQ(paths({folder / "."}),
            (std::vector<std::string>{folder / "./a.PLY", folder / "./b.pcd", folder / "./d.glb"}));
  EXPECT_EQ(paths({folder / "*.txt"}), std::vector<std::string>{folder / "c.txt"});
  const std::vector<InputFile> files = inputFiles({folder / "c.txt", folder / ".", folder / "c.txt"});
  ASSERT_EQ(files.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(files[i].folder, i % 4 == 0 ? "" : folder / ".");
  const std::string list = folder.write("list", "# comment\n" + (folder / "c.txt") + "\n\n  missing.pcd \n");
  EXPECT_EQ(paths({"@" + list, "-"}), (std::vector<std::string>{folder / "c.txt", "missing.pcd", "-"}));
  EXPECT_THROW(paths({folder / "*.stl"}), InputError);
  EXPECT_THROW(paths({"@" + (folder / "nowhere")}), InputError);
  EXPECT_TRUE(hasShapeExtension("a.XYZ"));
  EXPECT_FALSE(hasShapeExtension("a.or"));
  EXPECT_FALSE(hasShapeExtension("pcd"));
}

TEST(CSV, QuotesWhatItMust) {
  EXPECT_EQ(csvLine({"a \"b\", c", 1, 0.5, nullptr, "d"}), "\"a \"\"b\"\", c\",1,0.5,,d\n");
  EXPECT_EQ(firstCell("\"a \"\"b\"\", c\",1\n"), "a \"b\", c");
  EXPECT_EQ(firstCell("plain,1\n"), "plain");
}

TEST(StandardInput, KnowsKindsByTheirContent) {
  EXPECT_EQ(extensionOfContent("# .PCD v0.7\nVERSION"), ".pcd");
  EXPECT_EQ(extensionOfContent("VERSION 0.7\n"), ".pcd");
  EXPECT_EQ(extensionOfContent("ply\r\nformat"), ".ply");
  EXPECT_EQ(extensionOfContent("# a mesh\nv 1 2 3\n"), ".obj");
  EXPECT_EQ(extensionOfContent("COFF\n1 0 0\n"), ".off");
  EXPECT_EQ(extensionOfContent("solid cube\n"), ".stl");
  EXPECT_EQ(extensionOfContent(std::string(80, 'x') + std::string("\1\0\0\0", 4) + std::string(50, '\0')), ".stl");
  EXPECT_EQ(extensionOfContent("glTF...."), ".glb");
  EXPECT_EQ(extensionOfContent("\n# x y z\n-1.5 2 3\n"), ".xyz");
  EXPECT_EQ(extensionOfContent("//X Y Z\n1 2 3\n"), ".xyz");
  EXPECT_EQ(extensionOfContent("SOLID cube\n"), ".stl");
  EXPECT_EQ(extensionOfContent("hello"), "");
  EXPECT_EQ(extensionOfContent(""), "");
}

using pcl_symmetry::DetectionOptions;
using pcl_symmetry::Viewpoint;
using pcl_symmetry::test::complaintOf;

struct Values {
  std::string input;
  std::optional<std::string> output;
  std::optional<Eigen::Vector3d> direction, up;
  std::optional<std::string> png;
  double ratio = 0.5;
  bool all = false;
  std::string format = "binary";
  CommonOptions common;
};

bool parse(Values& values, std::vector<const char*> arguments) {
  CommandLine line("tool", "Does something.", "tool a.pcd -ratio 0.2");
  line.positional("input", values.input, "a cloud")
      .positional("output", values.output, "another cloud")
      .vector("direction", values.direction, "a direction")
      .number("ratio", values.ratio, Range{0, 1, true, false}, "a ratio")
      .flag("all", values.all, "everything")
      .choice("format", values.format, {"ascii", "binary"}, "encoding")
      .picture("png", values.png, "a picture")
      .direction("up", values.up, "a direction")
      .common(values.common, kShapeFlags | kSigma);
  arguments.insert(arguments.begin(), "tool");
  return line.parse(static_cast<int>(arguments.size()), arguments.data());
}

std::string complaintAbout(const std::vector<const char*>& arguments) {
  Values values;
  return complaintOf<UsageError>([&] { parse(values, arguments); });
}

TEST(Options, SingleAndDoubleDashMeanTheSame) {
  for (const char* dashes : {"-", "--"}) {
    const std::string seed = std::string(dashes) + "seed", all = std::string(dashes) + "all";
    Values values;
    ASSERT_TRUE(parse(values, {"in.pcd", seed.c_str(), "7", all.c_str(), "out.pcd"}));
    EXPECT_EQ(values.input, "in.pcd");
    EXPECT_EQ(values.output.value(), "out.pcd");
    EXPECT_EQ(values.common.seed, 7u);
    EXPECT_TRUE(values.all);
  }
}

TEST(Options, DefaultsStayWhenNothingIsGiven) {
  Values values;
  ASSERT_TRUE(parse(values, {"in.pcd"}));
  EXPECT_FALSE(values.output);
  EXPECT_FALSE(values.direction);
  EXPECT_EQ(values.ratio, 0.5);
  EXPECT_EQ(values.common.grid, 64);
  EXPECT_EQ(values.common.threads, 0);
  EXPECT_EQ(values.common.viewpoint.mode, Viewpoint::Mode::Auto);
  EXPECT_FALSE(values.common.quiet);
}

TEST(Options, NegativeVectorsAreValuesNotFlags) {
  Values values;
  ASSERT_TRUE(parse(values, {"in.pcd", "-direction", "-1,0,-0.25", "-viewpoint", "-1,2,0.5"}));
  EXPECT_EQ(values.direction.value(), Eigen::Vector3d(-1, 0, -0.25));
  EXPECT_EQ(values.common.viewpoint.mode, Viewpoint::Mode::Given);
  EXPECT_EQ(values.common.viewpoint.position, Eigen::Vector3d(-1, 2, 0.5));
}

TEST(Options, ViewpointKnowsItsWords) {
  EXPECT_EQ(parseViewpoint("-viewpoint", "none").mode, Viewpoint::Mode::None);
  EXPECT_EQ(parseViewpoint("-viewpoint", "auto").mode, Viewpoint::Mode::Auto);
  EXPECT_EQ(complaintAbout({"a", "-viewpoint", "never"}), "-viewpoint = never, must be auto, none or X,Y,Z");
  EXPECT_EQ(complaintAbout({"a", "-viewpoint", "1,2"}), "-viewpoint = 1,2, must be auto, none or X,Y,Z");
}

TEST(Options, ValuesOutOfRangeAreNamedWithTheirRule) {
  EXPECT_EQ(complaintAbout({"a", "-threads", "-1"}), "-threads = -1, must be >= 0 and <= 4096");
  EXPECT_EQ(complaintAbout({"a", "-ratio", "0"}), "-ratio = 0, must be > 0 and <= 1");
  EXPECT_EQ(complaintAbout({"a", "-ratio", "nan"}), "-ratio = nan, must be finite");
  EXPECT_EQ(complaintAbout({"a", "-ratio", "0.5x"}), "-ratio = 0.5x, must be a number");
  EXPECT_EQ(complaintAbout({"a", "-seed", "1.5"}), "-seed = 1.5, must be a whole number");
  EXPECT_EQ(complaintAbout({"a", "-seed", "-3"}), "-seed = -3, must be >= 0");
  EXPECT_EQ(complaintAbout({"a", "-seed", "99999999999999999999"}), "-seed = 99999999999999999999, is too large");
  EXPECT_EQ(complaintAbout({"a", "-direction", "1,nan,0"}), "-direction = 1,nan,0, must be three finite numbers X,Y,Z");
  EXPECT_EQ(complaintAbout({"a", "-format", "zip"}), "-format = zip, must be ascii|binary");
}

TEST(Options, PicturesArePNGAndDirectionsAreNotZero) {
  EXPECT_EQ(complaintAbout({"a", "-png", "out.jpg"}), "-png = out.jpg, must end in .png");
  EXPECT_EQ(complaintAbout({"a", "-png", "OUT.PNG"}), "no exception");
  EXPECT_EQ(complaintAbout({"a", "-up", "0,0,0"}), "-up = 0,0,0, must not be zero");
}

TEST(Options, CommonFlagsReachTheOptionsOfTheLibrary) {
  Values values;
  ASSERT_TRUE(parse(values, {"a", "-seed", "4", "-threads", "3", "-grid", "32", "-sigma", "0.5", "-points", "500"}));
  DetectionOptions options;
  values.common.applyTo(options);
  EXPECT_EQ(options.seed, 5u) << "the library starts at 1, the flag at 0";
  EXPECT_EQ(options.num_threads, 3);
  EXPECT_EQ(options.num_cells, 32);
  EXPECT_EQ(options.sigma, 0.5);
  EXPECT_EQ(values.common.mesh_points, 500);
}

TEST(FileErrors, NameTheFileAndNoFunction) {
  const auto complaint = [](const auto& body) { return complaintOf<InputError>([&] { namingFile("a.pcd", body); }); };
  EXPECT_EQ(complaint([] { throw pcl::BadArgumentException("points: all at one place", "file.cpp", "f()", 7); }),
            "a.pcd: points: all at one place");
  EXPECT_EQ(complaint([] { throw std::invalid_argument("sigma = -1, must be > 0"); }),
            "a.pcd: sigma = -1, must be > 0");
  EXPECT_EQ(complaint([] { throw InputError("b.pcd: is empty"); }), "b.pcd: is empty") << "named already";
  EXPECT_EQ(namingFile("a.pcd", [] { return 3; }), 3);
}

TEST(Options, UnknownFlagsAndMissingOnesAreErrors) {
  EXPECT_EQ(complaintAbout({"a", "-sead", "1"}), "unknown flag -sead, did you mean -seed?");
  EXPECT_EQ(complaintAbout({"a", "--bogus"}), "unknown flag --bogus");
  EXPECT_EQ(complaintAbout({}), "missing argument 'input'");
  EXPECT_EQ(complaintAbout({"a", "b", "c"}), "unexpected argument 'c'");
  EXPECT_NE(complaintAbout({"a", "-seed"}), "");
  EXPECT_NE(complaintAbout({"a", "-seed", "1", "-seed", "2"}), "");
  EXPECT_NE(complaintAbout({"a", "-see", "1"}), "") << "abbreviations must not be guessed";
}

TEST(Options, HelpShowsFlagsAndExample) {
  for (const char* help : {"-h", "-help", "--help"}) {
    Values values;
    testing::internal::CaptureStdout();
    EXPECT_FALSE(parse(values, {help}));
    const std::string text = testing::internal::GetCapturedStdout();
    for (const char* part : {"Usage: tool input [output]", "-threads N", "-viewpoint auto|none|X,Y,Z", "Example:"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }
    EXPECT_EQ(text.find(" --"), std::string::npos);
  }
}

TEST(Options, ListsOfNumbersAndOfArguments) {
  std::vector<std::string> folders;
  std::vector<double> noise = {0.5};
  const auto parseLists = [&](std::vector<const char*> arguments) {
    CommandLine line("tool", "Does.", "tool a");
    line.positionals("folder", folders, "some").numbers("noise", noise, Range::atLeast(0), "levels");
    arguments.insert(arguments.begin(), "tool");
    folders.clear();
    return line.parse(static_cast<int>(arguments.size()), arguments.data());
  };
  EXPECT_TRUE(parseLists({"a", "b", "c"}));
  EXPECT_EQ(folders, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(noise, std::vector<double>{0.5});
  EXPECT_TRUE(parseLists({"a", "-noise", "0,0.01,2"}));
  EXPECT_EQ(folders, std::vector<std::string>{"a"});
  EXPECT_EQ(noise, (std::vector<double>{0.0, 0.01, 2.0}));
  for (const char* bad : {"", "1,", "1,x", "1,-1", "1;2"}) EXPECT_THROW(parseLists({"a", "-noise", bad}), UsageError);
  EXPECT_THROW(parseLists({}), UsageError);
}

int exitCodeOf(const std::function<int(int, char**)>& body, std::string& message) {
  char name[] = "/somewhere/tool";
  char* arguments[] = {name, nullptr};
  testing::internal::CaptureStderr();
  const int code = runTool(1, arguments, body);
  message = testing::internal::GetCapturedStderr();
  return code;
}

TEST(RunTool, TurnsExceptionsIntoExitCodesAndOneLine) {
  std::string message;
  EXPECT_EQ(exitCodeOf([](int, char**) { return 0; }, message), 0);
  EXPECT_EQ(message, "");
  EXPECT_EQ(exitCodeOf([](int, char**) -> int { throw InputError("a.pcd: bad\nvery bad\n"); }, message), 1);
  EXPECT_EQ(message, "tool: a.pcd: bad very bad\n");
  EXPECT_EQ(exitCodeOf([](int, char**) -> int { throw UsageError("no"); }, message), 2);
  EXPECT_EQ(message, "tool: no (see tool -h)\n");
  EXPECT_EQ(exitCodeOf([](int, char**) -> int { throw std::bad_alloc(); }, message), 1);
  EXPECT_EQ(message, "tool: not enough memory\n");
  EXPECT_EQ(exitCodeOf([](int, char**) -> int { throw 3; }, message), 1);
}

}  // namespace
