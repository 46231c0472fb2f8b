#include "command_line/tool_errors.h"

#include <gtest/gtest.h>

#include "shapes/complaint.h"

namespace {

using namespace pcl_symmetry::apps;

using pcl_symmetry::test::complaintOf;

TEST(FileErrors, NameTheFileAndNoFunction) {
  const auto complaint = [](const auto& body) { return complaintOf<InputError>([&] { namingFile("a.pcd", body); }); };
  EXPECT_EQ(complaint([] { throw pcl::BadArgumentException("points: all at one place", "file.cpp", "f()", 7); }),
            "a.pcd: points: all at one place");
  EXPECT_EQ(complaint([] { throw std::invalid_argument("sigma = -1, must be > 0"); }),
            "a.pcd: sigma = -1, must be > 0");
  EXPECT_EQ(complaint([] { throw InputError("b.pcd: is empty"); }), "b.pcd: is empty") << "named already";
  EXPECT_EQ(namingFile("a.pcd", [] { return 3; }), 3);
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
