/// A program that changes a database until it is killed, and what has to be left then.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "core/base/random.h"
#include "pcl/lossy_disk.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::test {

enum class Interruption { Kill, PowerFailure };

/// Starts a writer, ends it at a random moment and looks at what it left, again and again on the same file.
class InterruptedWriter {
public:
  explicit InterruptedWriter(std::string file) : file_(std::move(file)) {}

  /// \return what was wrong; empty if nothing was.
  std::string run(Interruption interruption, std::uint64_t seed) {
    if (interruption == Interruption::Kill && usual_time_.count() == 0.0) {
      const std::string wrong = measureUsualTime(seed);
      if (!wrong.empty()) return wrong;
    }
    const Child child = start(interruption, seed);
    if (interruption == Interruption::Kill) {
      std::this_thread::sleep_for(2.0 * RandomStream(seed).uniform() * usual_time_);
      ::kill(child.process, SIGKILL);
    }
    std::string said;
    while (child.tell(said)) {
    }
    child.end();
    // The index of the log lies in memory: it does not survive.
    if (interruption == Interruption::PowerFailure) std::filesystem::remove(file_ + "-shm");
    return compare(said);
  }

  std::size_t numChanges() const { return num_changes_; }

private:
  /// A writer that runs.
  struct Child {
    pid_t process;
    int from_it;

    /// Adds what it says next. \return false if it will say nothing more.
    bool tell(std::string& said) const {
      char piece[4096];
      const ssize_t size = ::read(from_it, piece, sizeof(piece));
      if (size > 0) said.append(piece, static_cast<std::size_t>(size));
      return size > 0;
    }
    void end() const {
      ::close(from_it);
      ::waitpid(process, nullptr, 0);
    }
  };

  Child start(Interruption interruption, std::uint64_t seed) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t process = ::fork();
    if (process == 0) {
      ::close(ends[0]);
      if (interruption == Interruption::PowerFailure) {
        LossyDisk::use();
        LossyDisk::failAtWrite(static_cast<int>(RandomStream(seed).below(400)), seed);
      }
      write(ends[1], seed);
      ::_exit(0);
    }
    ::close(ends[1]);
    return {process, ends[0]};
  }

  /// How long a few changes take depends on the disk, and on what else runs.
  std::string measureUsualTime(std::uint64_t seed) {
    const auto begin = std::chrono::steady_clock::now();
    const Child child = start(Interruption::Kill, seed);
    std::string said;
    const std::string change = "done\n";
    for (std::size_t found = 0, from = 0; found < 10 && child.tell(said);)
      for (std::size_t place; (place = said.find(change, from)) != std::string::npos; ++found)
        from = place + change.size();
    usual_time_ = std::chrono::steady_clock::now() - begin;
    ::kill(child.process, SIGKILL);
    while (child.tell(said)) {
    }
    child.end();
    return compare(said);
  }

  /// Says what it is going to do, does it, and says that it is done.
  void write(int out, std::uint64_t seed) {
    RandomStream random(seed + 1);
    const auto say = [&](const std::string& line) {
      return ::write(out, (line + "\n").data(), line.size() + 1) == static_cast<ssize_t>(line.size() + 1);
    };
    try {
      detail::ModelStore store(file_, 10.0, "");
      for (int i = 0; i < 10'000; ++i) {
        const std::string name = "model_" + std::to_string(random.below(20));
        const std::string value = std::to_string(seed) + "_" + std::to_string(i);
        const bool adds = random.below(3) > 0;
        if (!say((adds ? "add " : "remove ") + name + " " + value)) return;
        const std::string part(1000 + random.below(20'000), static_cast<char>('a' + i % 26));
        if (adds)
          store.add({name, 0, {value, "", {}}, 1}, {part, part, part, 1}, 0, {});
        else
          store.remove(name);
        if (i % 16 == 0) store.setProjection({0, 1, part, part}, {});
        if (!say("done")) return;
      }
    } catch (const std::exception& error) {
      say(std::string("error ") + error.what());
    }
  }

  std::string compare(const std::string& said) {
    std::istringstream lines(said);
    std::map<std::string, std::string> with_last = models_;  // if the last change was made
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string what, name, value;
      words >> what >> name >> value;
      if (what == "error") return line;
      if (what == "add") with_last[name] = value;
      if (what == "remove") with_last.erase(name);
      if (what == "done") {
        models_ = with_last;
        ++num_changes_;
      }
    }
    if (!std::filesystem::exists(file_)) return models_.empty() ? "" : "the file is gone";
    try {
      detail::ModelStore store(file_, 10.0, "");
      for (const std::string& damage : store.damages()) return damage;
      std::map<std::string, std::string> found;
      for (const detail::StoredModel& model : store.models()) {
        found[model.name] = store.find(model.name)->second.source.path;
        store.part(detail::ModelPart::Cloud, model);
      }
      if (found != models_ && found != with_last) return "a model was lost, or one is there that was never added";
      models_ = found;
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  std::string file_;
  std::map<std::string, std::string> models_;  // what has to be there: the value of each name
  std::size_t num_changes_ = 0;
  std::chrono::duration<double> usual_time_{0.0};  // from the start of a writer to its tenth change
};

}  // namespace pcl_symmetry::test
