#include "common/processes/work_client.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace pcl_symmetry::apps {

namespace {

using ClientClock = std::chrono::steady_clock;

// Time between two signs of life. chosen: a tenth of the silence after which a process counts as dead; at half of it
// there are twice as many messages, at twice a busy machine might miss too many.
constexpr std::chrono::seconds kSignOfLife(1);
// Pause before a question is asked again. chosen: an item takes tens of milliseconds; half asks more often, twice is
// idle for longer at the end of a run.
constexpr std::chrono::milliseconds kAskAgain(10);
// Pause between two looks for an answer. chosen: as kAskAgain, it is rather shorter than an item.
constexpr std::chrono::microseconds kLookForAnswer(500);
// The first process answers in milliseconds, unless its disk is slow. chosen: at half of it a slow disk would end a
// process, at twice processes stay longer where the first one has died.
constexpr std::chrono::seconds kLongestAnswer(60);

}  // namespace

Message WorkClient::ask(Message question) {
  while (true) {
    channel_.send(0, question);
    const auto deadline = ClientClock::now() + kLongestAnswer;
    auto answer = channel_.receive();
    while (!answer) {
      if (ClientClock::now() > deadline) throw std::runtime_error("the first process of the run does not answer");
      std::this_thread::sleep_for(kLookForAnswer);
      answer = channel_.receive();
    }
    if (answer->second.word != Message::Word::Wait) return answer->second;
    if (question.word == Message::Word::Next) question = {question.word, question.run};  // the result was taken
    std::this_thread::sleep_for(kAskAgain);
  }
}

std::string WorkClient::hear() {
  return ask({Message::Word::Text, 0, num_texts_++}).bytes;
}

void WorkClient::run(const WorkFunctions& functions) {
  ++run_;
  Message answer = ask({Message::Word::Next, run_});
  while (answer.word == Message::Word::Item)
    answer = ask({Message::Word::Next, run_, answer.item, workOn(static_cast<std::size_t>(answer.item), functions)});
}

std::string WorkClient::workOn(std::size_t item, const WorkFunctions& functions) {
  std::mutex mutex;
  std::condition_variable ended;
  bool is_done = false;
  std::thread living([&] {
    std::unique_lock<std::mutex> lock(mutex);
    while (!ended.wait_for(lock, kSignOfLife, [&] { return is_done; })) {
      try {
        channel_.send(0, {Message::Word::Alive});
      } catch (const std::exception&) {  // the next question finds that the first process is gone
      }
    }
  });
  const auto stop = [&] {
    {
      const std::lock_guard<std::mutex> lock(mutex);
      is_done = true;
    }
    ended.notify_all();
    living.join();
  };
  try {
    std::string result = functions.work(item);
    stop();
    return result;
  } catch (...) {
    stop();
    throw;
  }
}

void WorkClient::leave() {
  channel_.send(0, {Message::Word::Gone});
}

}  // namespace pcl_symmetry::apps
