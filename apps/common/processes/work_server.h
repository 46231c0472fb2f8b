/// The first process of a run: it gives work to the others, takes what they have done, and notices those that died.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/processes/message_channel.h"
#include "common/processes/work_functions.h"

namespace pcl_symmetry::apps {

/// Answers the other processes on a thread of its own, which alone uses the channel.
class WorkServer {
public:
  explicit WorkServer(MessageChannel& channel);
  ~WorkServer();

  /// Other processes ask for texts in the order in which they are made known.
  void tell(const std::string& text);

  /// All items, those of this process on the calling thread.
  void run(std::size_t count, const WorkFunctions& functions);

  /// Waits until each process has gone or died, or waits for what will not be done.
  /// \return number of processes that have not gone.
  int close();

private:
  using Clock = std::chrono::steady_clock;

  struct Process {
    Clock::time_point heard;          ///< when it last said something
    std::optional<std::size_t> item;  ///< that it works on
    bool gone = false, is_dead = false, is_stuck = false;
  };

  void serve();
  void answer(int from, const Message& message);
  void reply(int to, const Message& message);
  void replyUnlessStuck(int to, const Message& message);
  Message textNumber(std::int64_t number);
  Message nextFor(int process, std::int64_t run);
  /// \return items that are given up.
  std::vector<std::size_t> findDead();
  bool isAnyAlive() const;
  std::optional<std::size_t> takeItem(bool also_returned);
  std::optional<std::size_t> waitForItem();
  void finish(std::int64_t run, std::size_t item, const std::string& result);
  void fail();

  MessageChannel& channel_;
  std::mutex mutex_;   ///< guards all below
  std::mutex taking_;  ///< one result at a time
  std::condition_variable changed_;
  std::vector<Process> processes_;
  std::vector<std::string> texts_;
  const WorkFunctions* functions_ = nullptr;  ///< while a run is under way
  std::int64_t run_ = 0;
  std::size_t next_ = 0, num_done_ = 0;
  std::vector<bool> done_;
  std::deque<std::size_t> returned_;       ///< by processes that died
  std::map<std::size_t, int> num_deaths_;  ///< of processes that worked on an item
  std::exception_ptr error_;
  bool leaving_ = false, closing_ = false;  ///< nothing more will be done; the thread ends
  std::thread thread_;
};

}  // namespace pcl_symmetry::apps
