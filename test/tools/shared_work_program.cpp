/// Work that tests let processes share: shared_work_program RESULTS COUNT [JOURNAL [HOW [ITEM]]]
///
/// The result of item i is i squared. HOW says who dies: "once", the process but the first one that is the first to get
/// ITEM or a later one; "always", every process but the first that gets ITEM; "first", the first process when it takes
/// ITEM; "take", none, but taking ITEM fails.
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "common/processes/result_journal.h"

namespace {

using namespace pcl_symmetry::apps;

/// \return whether this call made the folder.
bool isFirstTo(const std::string& make) {
  return mkdir(make.c_str(), 0700) == 0;
}

/// Ends the process that comes first, unless it is the first process: that waits until another one has died, so that
/// one does, however late it starts.
void dieOnce(const std::string& mark, bool is_first) {
  if (!is_first && isFirstTo(mark)) raise(SIGKILL);
  constexpr int kMostWaits = 3000;  // chosen: a minute, less than the limit of the test
  for (int k = 0; is_first && access(mark.c_str(), F_OK) != 0 && k < kMostWaits; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

int run(int argc, char** argv, SharedWork& processes) {
  const std::string results = argv[1], path = argc > 3 ? argv[3] : "", how = argc > 4 ? argv[4] : "";
  const std::size_t count = std::stoul(argv[2]), fatal = argc > 5 ? std::stoul(argv[5]) : count;
  std::unique_ptr<ResultJournal> journal;
  if (processes.isFirst() && !path.empty() && path != "none")
    journal = std::make_unique<ResultJournal>(path, "squares");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back("item " + std::to_string(i));
  std::vector<std::string> squares(count);
  std::size_t num_worked = 0, num_taken = 0;
  const auto work = [&](std::size_t i) {
    ++num_worked;
    // Every process gets items: none is fast enough to do them all.
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (i == fatal && how == "always" && !processes.isFirst()) raise(SIGKILL);
    if (i >= fatal && how == "once") dieOnce(results + ".died", processes.isFirst());
    return std::to_string(i * i);
  };
  const auto take = [&](std::size_t i, const std::string& result) {
    if (i == fatal && how == "first" && isFirstTo(results + ".died")) raise(SIGKILL);
    if (i == fatal && how == "take") throw std::runtime_error("item " + std::to_string(i) + ": there is no place");
    squares[i] = result;
    ++num_taken;
  };
  runWithJournal(processes, journal.get(), names, {work, take, [](std::size_t) { return std::string("lost"); }}, 1);
  std::string text = "and all know";
  processes.broadcast(text);
  if (text != "and all know") return 3;
  if (!processes.isFirst()) return 0;
  std::ofstream file(results);
  for (const std::string& square : squares) file << square << '\n';
  std::cout << num_taken << " taken, " << num_worked << " done here\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  SharedWork processes;
  int code = 1;
  try {
    code = run(argc, argv, processes);
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
  }
  return processes.end(code);
}
