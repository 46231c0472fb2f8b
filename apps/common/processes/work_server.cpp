#include "common/processes/work_server.h"

#include <algorithm>

namespace pcl_symmetry::apps {

namespace {

// A process that says nothing for so long has died; each says once a second that it is at work. chosen: at half of it a
// process on a busy machine would be given up, which costs the time of its item; twice waits longer for one that died.
constexpr std::chrono::seconds kSilence(10);
// Pause between two looks for messages. chosen: an item takes tens of milliseconds; half and twice take the same time.
constexpr std::chrono::milliseconds kLook(1);
// Processes that may die of an item. chosen: with one, a process that is killed costs its item; with three, an item
// that kills whoever works on it takes one process more.
constexpr int kMostDeaths = 2;

}  // namespace

WorkServer::WorkServer(MessageChannel& channel)
    : channel_(channel), processes_(static_cast<std::size_t>(channel.size())) {
  for (Process& process : processes_) process.heard = Clock::now();
  processes_.front().gone = true;  // this one
  thread_ = std::thread([this] { serve(); });
}

WorkServer::~WorkServer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  thread_.join();
}

void WorkServer::tell(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  texts_.push_back(text);
}

void WorkServer::run(std::size_t count, const WorkFunctions& functions) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++run_;
    next_ = num_done_ = 0;
    done_.assign(count, false);
    returned_.clear();
    num_deaths_.clear();
    functions_ = &functions;
  }
  try {
    while (const std::optional<std::size_t> item = waitForItem()) finish(run_, *item, functions.work(*item));
  } catch (...) {
    fail();
  }
  const std::lock_guard<std::mutex> none_takes(taking_);
  const std::lock_guard<std::mutex> lock(mutex_);
  functions_ = nullptr;
  if (error_) std::rethrow_exception(error_);
}

int WorkServer::close() {
  const auto is_over = [this] {
    return std::all_of(processes_.begin(), processes_.end(), [](const Process& p) { return p.gone || p.is_dead; });
  };
  std::unique_lock<std::mutex> lock(mutex_);
  leaving_ = true;
  changed_.wait(lock, is_over);
  return static_cast<int>(
      std::count_if(processes_.begin(), processes_.end(), [](const Process& p) { return p.is_dead || p.is_stuck; }));
}

void WorkServer::serve() {
  while (true) {
    try {
      while (const auto received = channel_.receive()) answer(received->first, received->second);
      std::unique_lock<std::mutex> lock(mutex_);
      if (closing_) return;
      const std::vector<std::size_t> given_up = findDead();
      const WorkFunctions* const functions = functions_;
      const std::int64_t run = run_;
      lock.unlock();
      for (const std::size_t item : given_up) finish(run, item, functions->lost(item));
    } catch (...) {
      fail();
    }
    std::this_thread::sleep_for(kLook);
  }
}

void WorkServer::answer(int from, const Message& message) {
  using Word = Message::Word;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Process& process = processes_[static_cast<std::size_t>(from)];
    process.heard = Clock::now();
    process.is_dead = false;
    if (message.word == Word::Next) process.item.reset();
    if (message.word == Word::Gone) process.gone = true;
    changed_.notify_all();
  }
  if (message.word == Word::Text) replyUnlessStuck(from, textNumber(message.item));
  if (message.word != Word::Next) return;
  if (message.item >= 0) finish(message.run, static_cast<std::size_t>(message.item), message.bytes);
  replyUnlessStuck(from, nextFor(from, message.run));
}

/// A process that waits for what this one will not do any more, as it failed, is stuck.
void WorkServer::replyUnlessStuck(int to, const Message& message) {
  if (message.word == Message::Word::Wait) {
    const std::lock_guard<std::mutex> lock(mutex_);
    Process& process = processes_[static_cast<std::size_t>(to)];
    if (leaving_) process.is_stuck = process.gone = true;
    changed_.notify_all();
  }
  reply(to, message);
}

/// A process that dies before it has its answer is found by its silence.
void WorkServer::reply(int to, const Message& message) {
  try {
    channel_.send(to, message);
  } catch (const std::exception&) {
  }
}

Message WorkServer::textNumber(std::int64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto index = static_cast<std::size_t>(number);
  if (index >= texts_.size()) return {Message::Word::Wait};
  return {Message::Word::Text, 0, number, texts_[index]};
}

Message WorkServer::nextFor(int process, std::int64_t run) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (run > run_) return {Message::Word::Wait};  // this process has not come there yet
  if (run < run_ || !functions_ || error_ || num_done_ == done_.size()) return {Message::Word::Over};
  const std::optional<std::size_t> item = takeItem(true);
  if (!item) return {Message::Word::Wait};
  processes_[static_cast<std::size_t>(process)].item = item;
  return {Message::Word::Item, run_, static_cast<std::int64_t>(*item)};
}

std::vector<std::size_t> WorkServer::findDead() {
  std::vector<std::size_t> given_up;
  for (Process& process : processes_) {
    if (process.gone || process.is_dead || Clock::now() - process.heard < kSilence) continue;
    process.is_dead = true;
    if (process.item && functions_ && ++num_deaths_[*process.item] < kMostDeaths)
      returned_.push_back(*process.item);
    else if (process.item && functions_)
      given_up.push_back(*process.item);
    process.item.reset();
    changed_.notify_all();
  }
  return given_up;
}

bool WorkServer::isAnyAlive() const {
  return std::any_of(processes_.begin(), processes_.end(), [](const Process& p) { return !p.gone && !p.is_dead; });
}

std::optional<std::size_t> WorkServer::takeItem(bool also_returned) {
  if (next_ < done_.size()) return next_++;
  while (also_returned && !returned_.empty()) {
    const std::size_t item = returned_.front();
    returned_.pop_front();
    if (!done_[item]) return item;
  }
  return std::nullopt;
}

/// Items of processes that died are left to the others while one of them lives: what killed two would end the run here.
std::optional<std::size_t> WorkServer::waitForItem() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!error_ && num_done_ < done_.size()) {
    if (const std::optional<std::size_t> item = takeItem(!isAnyAlive())) return item;
    changed_.wait(lock);
  }
  return std::nullopt;
}

void WorkServer::finish(std::int64_t run, std::size_t item, const std::string& result) {
  try {
    const std::lock_guard<std::mutex> taking(taking_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!functions_ || run != run_ || done_[item]) return;
    }
    functions_->take(item, result);
    const std::lock_guard<std::mutex> lock(mutex_);
    done_[item] = true;
    ++num_done_;
    changed_.notify_all();
  } catch (...) {
    fail();
  }
}

/// Called in a handler: the run ends with what was thrown first.
void WorkServer::fail() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!error_) error_ = std::current_exception();
  changed_.notify_all();
}

}  // namespace pcl_symmetry::apps
