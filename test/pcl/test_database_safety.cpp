/// What a database says of damaged bytes, full disks, folders that cannot be written and other writers. That killed
/// programs lose nothing and that many read while one writes is tested by SQLite.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "recognition/model_store.h"
#include "shapes/complaint.h"
#include "shapes/temporary_folder.h"

namespace pcl_symmetry {

namespace {

namespace fs = std::filesystem;
using detail::ModelPart;
using detail::ModelStore;
using test::complaintOf;

class DatabaseSafety : public testing::Test {
protected:
  void TearDown() override { fs::permissions(folder_ / "", fs::perms::owner_all); }

  static void add(ModelStore& store, const std::string& name, const std::string& part = "a part of a model") {
    store.add({name, 7, {"source of " + name, "", {}}, 1}, {part, part, part, part, 1}, 0, {});
  }

  /// A file of one model.
  void makeFirst() const {
    ModelStore store(file_, 1.0, "");
    add(store, "first");
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "models.db";
};

/// What a file holds, word for word.
std::vector<std::string> contentsIn(const std::string& file) {
  ModelStore store(file, 1.0, "");
  std::vector<std::string> contents;
  for (const auto& model : store.models()) {
    contents.push_back(model.name);
    for (const auto part : {ModelPart::Cloud, ModelPart::Signatures, ModelPart::Views, ModelPart::Surfaces})
      contents.push_back(store.part(part, model));
    if (const auto info = store.find(model.name)) contents.push_back(info->second.source.path);
  }
  if (store.projection()) contents.push_back(store.projection()->values);
  for (const auto form : {detail::FormPart::Compact, detail::FormPart::ViewCodes})
    store.each(form, 1, [&](std::int64_t, const std::string& bytes) { contents.push_back(bytes); });
  return contents;
}

/// A byte that is changed is found, or changes nothing of what is read.
TEST_F(DatabaseSafety, DamagedBytesAreFoundOrHarmless) {
  const std::string long_part(5000, 'x');
  {
    ModelStore store(file_, 1.0, "m");
    for (const char* name : {"cube", "beam", "a longer name", "gone"}) add(store, name, name + long_part);
    store.setProjection({0, 3, "projection" + long_part, "coder"},
                        {{1, "form" + long_part, "codes"}, {2, "form" + long_part, "codes"}});
    store.remove("gone");
  }
  const std::string whole = contentOf(file_);
  const std::vector<std::string> expected = contentsIn(file_);
  RandomStream random(1);
  int num_found = 0;
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t place = i < 100 ? i : random.below(whole.size());  // the first 100 are the header
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ (i % 2 == 0 ? 0xff : 1 << random.below(8)));
    folder_.write("models.db", damaged);
    bool is_found = true;
    try {
      is_found = !SymmetryDatabase::check(file_).empty();
    } catch (const pcl::IOException&) {
    }
    num_found += is_found ? 1 : 0;
    try {
      const std::vector<std::string> contents = contentsIn(file_);
      for (const std::string& bytes : contents)
        EXPECT_GT(std::count(expected.begin(), expected.end(), bytes), 0) << "byte " << place;
      EXPECT_TRUE(is_found || contents == expected) << "byte " << place;
    } catch (const pcl::IOException& error) {
      EXPECT_TRUE(is_found) << "byte " << place << ", found only when it is read: " << error.what();
    }
    for (const char* ending : {"-wal", "-shm"}) fs::remove(file_ + ending);
  }
  EXPECT_GT(num_found, 150);
}

TEST_F(DatabaseSafety, FullDisksLeaveTheDatabaseAsItWas) {
  makeFirst();
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{}, before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  limit = before;
  limit.rlim_cur = 200'000;
  {
    ModelStore store(file_, 1.0, "");
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = complaintOf<std::exception>([&] { add(store, "large", std::string(300'000, 'x')); });
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
  makeFirst();
  constexpr auto kRead = static_cast<fs::perms>(0444), kReadAndEnter = static_cast<fs::perms>(0555);
  fs::permissions(file_, kRead);
  fs::permissions(folder_ / "", kReadAndEnter);
  // Permissions do not bind root.
  const pid_t child = ::fork();
  if (child == 0) {
    if (::geteuid() == 0 && ::seteuid(65534) != 0) ::_exit(9);
    int code = 0;
    const std::string message = complaintOf<std::exception>([&] {
      ModelStore store(file_, 1.0, "");
      code +=
          store.models().size() == 1 && store.part(ModelPart::Cloud, store.models()[0]) == "a part of a model" ? 1 : 0;
      add(store, "second");
    });
    code += message == file_ + ": cannot be written: the file or its folder may only be read" ? 2 : 0;
    const std::string other = folder_ / "new.db";
    const std::string made = complaintOf<std::exception>([&] {
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
    folder_.write("models.db", content);
    EXPECT_EQ(complaintOf<std::exception>([&] { ModelStore(file_, 1.0, ""); }),
              file_ + ": is no database of pcl_symmetry, or its first 100 bytes are damaged; it is left as it is");
    EXPECT_EQ(contentOf(file_), content);
  }
  fs::remove(file_);
  folder_.write("models.db-wal", "mine");
  EXPECT_EQ(complaintOf<std::exception>([&] {
              ModelStore store(file_, 1.0, "");
              add(store, "first");
            }),
            file_ + "-wal: must not exist, as a new database needs a file of this name");
  EXPECT_EQ(contentOf(file_ + "-wal"), "mine");
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_NE(complaintOf<std::exception>([&] {
              ModelStore store(folder_ / "no/such/models.db", 1.0, "");
              add(store, "first");
            }).find("models.db: cannot be made: there is no folder "),
            std::string::npos);
  EXPECT_EQ(complaintOf<std::exception>([&] { ModelStore("/dev/null", 1.0, ""); }), "/dev/null: must be a file");
}

TEST_F(DatabaseSafety, RefusesOtherVersions) {
  makeFirst();
  const std::string whole = contentOf(file_);
  for (const char version : {detail::kSchemaVersion - 1, detail::kSchemaVersion + 1}) {
    std::string other = whole;
    other[63] = version;  // the last byte of user_version in the header
    folder_.write("models.db", other);
    const std::string message = complaintOf<std::exception>([&] { ModelStore(file_, 1.0, ""); });
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
    EXPECT_EQ(complaintOf<std::exception>([&] { add(store, "second"); }),
              file_ + ": another program is changing it, try again when that is done");
    EXPECT_EQ(store.models().size(), 1u) << "readers do not wait";
  }
  add(store, "second");
  EXPECT_EQ(store.models().size(), 2u);
}

}  // namespace

}  // namespace pcl_symmetry
