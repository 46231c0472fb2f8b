/// What a database says of damaged bytes, full disks, folders that cannot be written and other writers. That killed
/// programs lose nothing and that many read while one writes is tested by SQLite.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include "pcl/damaged_database.h"
#include "recognition/database_schema.h"
#include "recognition/model_store.h"

namespace pcl_symmetry {

namespace {

namespace fs = std::filesystem;
using detail::ModelPart;
using detail::ModelStore;

class DatabaseSafety : public testing::Test {
protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::permissions(folder_, fs::perms::owner_all);
    fs::remove_all(folder_);
  }

  static void add(ModelStore& store, const std::string& name, const std::string& part = "a part of a model") {
    store.add({name, 7, {"source of " + name, "", {}}, 1}, {part, part, part, 1}, 0, {});
  }
  static std::string messageOf(const std::function<void()>& body) {
    try {
      body();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no exception";
  }
  static std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::string folder_ =
      testing::TempDir() + "database_safety_" + testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string file_ = folder_ + "/models.db";
};

TEST_F(DatabaseSafety, DamagedBytesAreFoundOrHarmless) {
  test::DamagedDatabase database(file_);
  RandomStream random(1);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t place = i < 100 ? i : random.below(database.size());  // the first 100 are the header
    const char mask = static_cast<char>(i % 2 == 0 ? 0xff : 1 << random.below(8));
    EXPECT_EQ(database.flip(place, mask), "") << "byte " << place;
  }
  EXPECT_GT(database.numFound(), 150);
}

TEST_F(DatabaseSafety, FullDisksLeaveTheDatabaseAsItWas) {
  {
    ModelStore store(file_, 1.0, "");
    add(store, "first");
  }
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{}, before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  limit = before;
  limit.rlim_cur = 200'000;
  {
    ModelStore store(file_, 1.0, "");
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = messageOf([&] { add(store, "large", std::string(300'000, 'x')); });
    EXPECT_NE(message.find("models.db: cannot be "), std::string::npos) << message;
    EXPECT_NE(message.find("the database is unchanged"), std::string::npos) << message;
    EXPECT_EQ(store.models().size(), 1u) << "the same store goes on";
    add(store, "small");
    ::setrlimit(RLIMIT_FSIZE, &before);
  }
  ModelStore store(file_, 1.0, "");
  EXPECT_EQ(store.models().size(), 2u);
  EXPECT_TRUE(store.damages().empty());
}

TEST_F(DatabaseSafety, ReadsWhereNothingMayBeWritten) {
  {
    ModelStore store(file_, 1.0, "");
    add(store, "first");
  }
  constexpr auto kRead = static_cast<fs::perms>(0444), kReadAndEnter = static_cast<fs::perms>(0555);
  fs::permissions(file_, kRead);
  fs::permissions(folder_, kReadAndEnter);
  // Permissions do not bind root.
  const pid_t child = ::fork();
  if (child == 0) {
    if (::geteuid() == 0 && ::seteuid(65534) != 0) ::_exit(9);
    int code = 0;
    const std::string message = messageOf([&] {
      ModelStore store(file_, 1.0, "");
      code +=
          store.models().size() == 1 && store.part(ModelPart::Cloud, store.models()[0]) == "a part of a model" ? 1 : 0;
      add(store, "second");
    });
    code += message == file_ + ": cannot be written: the file or its folder may only be read" ? 2 : 0;
    const std::string other = folder_ + "/new.db";
    const std::string made = messageOf([&] {
      ModelStore store(other, 1.0, "");
      add(store, "first");
    });
    code += made == other + ": cannot be made: its folder may only be read" ? 4 : 0;
    if (code != 7) std::fprintf(stderr, "%s\n%s\n", message.c_str(), made.c_str());
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST_F(DatabaseSafety, TouchesNothingThatItDidNotWrite) {
  const std::string mine[] = {"", "mine", std::string("SQLite format 3\0", 16) + std::string(200, '\1')};
  for (const std::string& content : mine) {
    std::ofstream(file_, std::ios::binary) << content;
    EXPECT_EQ(messageOf([&] { ModelStore(file_, 1.0, ""); }),
              file_ + ": is no database of pcl_symmetry, or its first 100 bytes are damaged; it is left as it is");
    EXPECT_EQ(bytesOf(file_), content);
  }
  fs::remove(file_);
  std::ofstream(file_ + "-wal") << "mine";
  EXPECT_EQ(messageOf([&] {
              ModelStore store(file_, 1.0, "");
              add(store, "first");
            }),
            file_ + "-wal: must not exist, as a new database needs a file of this name");
  EXPECT_EQ(bytesOf(file_ + "-wal"), "mine");
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_NE(messageOf([&] {
              ModelStore store(folder_ + "/no/such/models.db", 1.0, "");
              add(store, "first");
            }).find("models.db: cannot be made: there is no folder "),
            std::string::npos);
  EXPECT_EQ(messageOf([&] { ModelStore("/dev/null", 1.0, ""); }), "/dev/null: must be a file");
}

TEST_F(DatabaseSafety, RefusesOtherVersions) {
  {
    ModelStore store(file_, 1.0, "");
    add(store, "first");
  }
  const std::string whole = bytesOf(file_);
  for (const char version : {detail::kSchemaVersion - 1, detail::kSchemaVersion + 1}) {
    std::string other = whole;
    other[63] = version;  // the last byte of user_version in the header
    std::ofstream(file_, std::ios::binary) << other;
    const std::string message = messageOf([&] { ModelStore(file_, 1.0, ""); });
    EXPECT_NE(message.find(version < detail::kSchemaVersion ? "an older library wrote" : "a newer library wrote"),
              std::string::npos);
  }
}

TEST_F(DatabaseSafety, SecondWritersWaitAndThenSayWhy) {
  ModelStore store(file_, 0.1, "");
  add(store, "first");
  {
    const detail::SQLiteConnection other(file_, detail::SQLiteAccess::Change, 1.0);
    const detail::SQLiteTransaction transaction(other);
    EXPECT_EQ(messageOf([&] { add(store, "second"); }),
              file_ + ": another program is changing it, try again when that is done");
    EXPECT_EQ(store.models().size(), 1u) << "readers do not wait";
  }
  add(store, "second");
  EXPECT_EQ(store.models().size(), 2u);
}

}  // namespace

}  // namespace pcl_symmetry
