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
#include <vector>

#include "core/base/random.h"
#include "recognition/database_schema.h"
#include "recognition/model_store.h"
#include "shapes/complaint.h"
#include "shapes/temporary_folder.h"

namespace pcl_symmetry {

namespace {

namespace fs = std::filesystem;
using detail::ModelPart;
using detail::ModelStore;
using test::complaintOf;

/// A small database of which single bytes are changed.
class DamagedDatabase {
public:
  explicit DamagedDatabase(std::string file) : file_(std::move(file)) {
    {
      detail::ModelStore store(file_, 1.0, "m");
      for (const char* name : {"cube", "beam", "a longer name", "gone"}) store.add(infoOf(name), modelOf(name), 0, {});
      store.setProjection({0, 3, partOf("projection"), partOf("coder")},
                          {{1, partOf("form"), partOf("codes")}, {2, partOf("form"), partOf("codes")}});
      store.remove("gone");
    }
    whole_ = contentOf(file_);
  }

  std::size_t size() const { return whole_.size(); }
  int numFound() const { return num_found_; }

  /// Changes the bits of the mask in one byte of the whole database.
  /// \return what is wrong with what the library makes of it; empty: the damage is found, or is none.
  std::string flip(std::size_t place, char mask) {
    std::string damaged = whole_;
    damaged[place] = static_cast<char>(damaged[place] ^ mask);
    std::ofstream(file_, std::ios::binary) << damaged;
    bool found = false;
    try {
      found = !SymmetryDatabase::check(file_).empty();
    } catch (const pcl::IOException&) {
      found = true;
    }
    num_found_ += found ? 1 : 0;
    const std::string wrong = read(found);
    for (const char* ending : {"-wal", "-shm"}) std::filesystem::remove(file_ + ending);
    return wrong;
  }

private:
  static ModelInfo infoOf(const std::string& name) { return {name, 7, {"source of " + name, "", {}}, 1}; }
  static std::string partOf(const std::string& name) { return "part of " + name + std::string(5000, 'x'); }
  static detail::PackedModel modelOf(const std::string& name) { return {partOf(name), partOf(name), partOf(name), 1}; }

  /// \return what was read that was never written.
  std::string read(bool found) const {
    try {
      detail::ModelStore store(file_, 1.0, "");
      std::vector<std::string> names;
      for (const auto& model : store.models()) {
        names.push_back(model.name);
        for (const auto part : {detail::ModelPart::Cloud, detail::ModelPart::Signatures, detail::ModelPart::Views})
          if (store.part(part, model) != partOf(model.name)) return "another part of " + model.name;
        const auto info = store.find(model.name);
        if (info && info->second.source.path != "source of " + model.name) return "another source of " + model.name;
      }
      if (store.projection() && store.projection()->values != partOf("projection")) return "another projection";
      store.each(detail::FormPart::Compact, 1, [](std::int64_t, const std::string& bytes) {
        if (bytes != partOf("form")) throw std::runtime_error("another compact form");
      });
      store.each(detail::FormPart::ViewCodes, 1, [](std::int64_t, const std::string& bytes) {
        if (bytes != partOf("codes")) throw std::runtime_error("other codes of views");
      });
      for (const std::string& name : names)
        if (name != "cube" && name != "beam" && name != "a longer name") return "a model " + name;
      if (!found && names.size() != 3) return "a model is lost without a word";
    } catch (const pcl::IOException& error) {
      return found ? "" : std::string("found only when it is read: ") + error.what();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  std::string file_, whole_;
  int num_found_ = 0;
};

class DatabaseSafety : public testing::Test {
protected:
  void TearDown() override { fs::permissions(folder_ / "", fs::perms::owner_all); }

  static void add(ModelStore& store, const std::string& name, const std::string& part = "a part of a model") {
    store.add({name, 7, {"source of " + name, "", {}}, 1}, {part, part, part, 1}, 0, {});
  }

  /// A file of one model.
  void makeFirst() const {
    ModelStore store(file_, 1.0, "");
    add(store, "first");
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "models.db";
};

TEST_F(DatabaseSafety, DamagedBytesAreFoundOrHarmless) {
  DamagedDatabase database(file_);
  RandomStream random(1);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t place = i < 100 ? i : random.below(database.size());  // the first 100 are the header
    const char mask = static_cast<char>(i % 2 == 0 ? 0xff : 1 << random.below(8));
    EXPECT_EQ(database.flip(place, mask), "") << "byte " << place;
  }
  EXPECT_GT(database.numFound(), 150);
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
