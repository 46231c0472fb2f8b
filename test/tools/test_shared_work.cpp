#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <fstream>
#include <string>

#include "tools/temporary_folder.h"
#include "tools/tool_run.h"
#include "command_line/tool_errors.h"
#include "common/processes/result_journal.h"

namespace {

using namespace pcl_symmetry::apps;

class Journal : public testing::Test {
protected:
  void write(const std::string& bytes) { std::ofstream(path_, std::ios::binary) << bytes; }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "journal";
};

TEST_F(Journal, KeepsResults) {
  ResultJournal(path_, "squares").add("two", "4");
  ResultJournal(path_, "squares").add("three", std::string("9\0\n", 3));
  const ResultJournal read(path_, "squares");
  ASSERT_EQ(read.results().size(), 2u);
  EXPECT_EQ(read.results().at("two"), "4");
  EXPECT_EQ(read.results().at("three"), std::string("9\0\n", 3));
}

TEST_F(Journal, LeavesOutWhatWasCutOff) {
  {
    ResultJournal journal(path_, "squares");
    journal.add("two", "4");
    journal.add("three", "9");
  }
  const std::string whole = contentOf(path_);
  for (std::size_t cut = 1; cut <= std::string("three9").size() + 16; ++cut) {
    write(whole.substr(0, whole.size() - cut));
    ResultJournal journal(path_, "squares");
    ASSERT_EQ(journal.results().size(), 1u) << cut;
    journal.add("four", "16");
    EXPECT_EQ(ResultJournal(path_, "squares").results().at("four"), "16") << cut;
  }
  std::string changed = whole;
  changed.back() = '8';
  write(changed);
  EXPECT_EQ(ResultJournal(path_, "squares").results().count("three"), 0u) << "its checksum is another one";
}

TEST_F(Journal, IsOfOnePurpose) {
  ResultJournal(path_, "squares").add("two", "4");
  const std::string before = contentOf(path_);
  EXPECT_THROW(ResultJournal(path_, "cubes"), InputError);
  EXPECT_EQ(contentOf(path_), before);
  write("something else");
  EXPECT_THROW(ResultJournal(path_, "squares"), InputError);
  EXPECT_EQ(contentOf(path_), "something else") << "what is no journal is not changed";
  EXPECT_THROW(ResultJournal(folder_ / "no/folder", "squares"), InputError);
}

class SharedWorkProgram : public ToolTest {
protected:
  SharedWorkProgram() : ToolTest("") {}

  void SetUp() override {
#ifndef MPI_RUN
    GTEST_SKIP() << "the tools are built without MPI";
#endif
  }

  /// \param flags of mpirun.
  int share(int num_processes, const std::string& arguments, const std::string& flags = "") {
#ifdef MPI_RUN
    return run("timeout 100 " MPI_RUN " -n " + std::to_string(num_processes) +
               " --allow-run-as-root --oversubscribe --bind-to none " + flags + " " + PROGRAM + " " + results_ + " " +
               arguments);
#else
    return -1;
#endif
  }

  static std::string squares(int count, int lost = -1) {
    std::string text;
    for (int i = 0; i < count; ++i) text += (i == lost ? "lost" : std::to_string(i * i)) + "\n";
    return text;
  }

  const std::string results_ = folder_ / "results";
};

TEST_F(SharedWorkProgram, DoesEachItemOnce) {
  for (const int processes : {1, 2, 4}) {
    ASSERT_EQ(share(processes, "60"), 0) << error_;
    EXPECT_EQ(contentOf(results_), squares(60));
    EXPECT_EQ(output_.rfind("60 taken", 0), 0u) << output_;
    EXPECT_EQ(output_.find("60 done here") == std::string::npos, processes > 1) << output_;
  }
  ASSERT_EQ(run(PROGRAM " " + results_ + " 10"), 0) << "without mpirun";
  EXPECT_EQ(contentOf(results_), squares(10));
}

TEST_F(SharedWorkProgram, GoesOnWithoutAProcessThatDied) {
  ASSERT_EQ(share(3, "60 none once 30", "--enable-recovery"), 0) << error_;
  EXPECT_EQ(contentOf(results_), squares(60));
}

TEST_F(SharedWorkProgram, GivesUpAnItemThatKillsTwice) {
  share(4, "60 none always 1", "--enable-recovery");
  const std::string found = contentOf(results_);
  // The first process may have got the item itself.
  EXPECT_TRUE(found == squares(60, 1) || found == squares(60)) << found;
}

TEST_F(SharedWorkProgram, GoesOnWhereItEnded) {
  const std::string journal = folder_ / "journal";
  EXPECT_NE(share(3, "60 " + journal + " first 30"), 0) << "without its first process nothing goes on";
  EXPECT_FALSE(boost::filesystem::exists(results_));
  ASSERT_EQ(run(PROGRAM " " + results_ + " 60 " + journal), 0) << error_;
  EXPECT_EQ(contentOf(results_), squares(60));
  EXPECT_EQ(output_.find("60 done here"), std::string::npos) << "some were there: " << output_;
  ASSERT_EQ(share(2, "60 " + journal), 0) << error_;
  EXPECT_EQ(output_, "60 taken, 0 done here\n") << "nothing was left to do";
  EXPECT_EQ(contentOf(results_), squares(60));
}

TEST_F(SharedWorkProgram, EndsAllWhereMPIDoesNotLetOthersLive) {
  const std::string journal = folder_ / "journal";
  EXPECT_NE(share(3, "60 " + journal + " once 30"), 0);
  ASSERT_EQ(share(3, "60 " + journal), 0) << error_;
  EXPECT_EQ(contentOf(results_), squares(60));
}

TEST_F(SharedWorkProgram, EndsWhereTheFirstProcessFails) {
  EXPECT_EQ(share(3, "60 none take 30"), 1);
  EXPECT_NE(error_.find("item 30: there is no place"), std::string::npos) << error_;
  EXPECT_FALSE(boost::filesystem::exists(results_));
}

}  // namespace
