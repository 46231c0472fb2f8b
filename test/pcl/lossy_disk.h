/// A disk that forgets what was not synchronised when the power fails, for tests of the database.
#pragma once

#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"

namespace pcl_symmetry::test {

/// SQLite's files, with what was written since they were synchronised last.
class LossyDisk {
public:
  /// Every file that SQLite opens from now on lies on this disk.
  static void use() {
    static sqlite3_vfs vfs = *sqlite3_vfs_find(nullptr);
    vfs.pNext = nullptr;
    vfs.zName = "lossy";
    vfs.szOsFile = static_cast<int>(sizeof(File)) + real().szOsFile;
    vfs.xOpen = &open;
    sqlite3_vfs_register(&vfs, 1);
  }

  /// From the write of this number on nothing reaches the disk, and of what was not synchronised a part is lost, drawn
  /// at random; then the program ends.
  static void failAtWrite(int number, std::uint64_t seed) {
    state().fatal_write = number;
    state().seed = seed;
  }

private:
  static constexpr sqlite3_int64 kPiece = 65'536;  // bytes; SQLite's files take less than 131 072 at once

  struct Write {
    sqlite3_int64 offset;
    std::string data;
    bool truncates;  // the file ends at the offset
  };
  struct Pending {
    std::vector<Write> writes;
    std::string before;  // the whole file when it was synchronised last; files of tests are small
  };
  struct File {
    sqlite3_file base;
    Pending* pending;
    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
  };
  struct State {
    int fatal_write = -1, num_writes = 0;
    std::uint64_t seed = 0;
    std::set<File*> files;
  };

  static State& state() {
    static State value;
    return value;
  }
  static sqlite3_vfs& real() {
    static sqlite3_vfs* const vfs = sqlite3_vfs_find("unix");
    return *vfs;
  }
  static File& self(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }

  static std::string contentOf(sqlite3_file* file) {
    sqlite3_int64 size = 0;
    file->pMethods->xFileSize(file, &size);
    std::string content(static_cast<std::size_t>(size), '\0');
    for (sqlite3_int64 at = 0; at < size; at += kPiece)
      file->pMethods->xRead(file, content.data() + at, static_cast<int>(std::min(kPiece, size - at)), at);
    return content;
  }
  static void replaceContent(sqlite3_file* file, const std::string& content) {
    const auto size = static_cast<sqlite3_int64>(content.size());
    file->pMethods->xTruncate(file, 0);
    for (sqlite3_int64 at = 0; at < size; at += kPiece)
      file->pMethods->xWrite(file, content.data() + at, static_cast<int>(std::min(kPiece, size - at)), at);
  }

  static int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    File& opened = self(file);
    opened.base.pMethods = nullptr;
    std::memset(opened.real(), 0, static_cast<std::size_t>(real().szOsFile));
    const int code = real().xOpen(&real(), name, opened.real(), flags, out_flags);
    if (opened.real()->pMethods == nullptr) return code;
    static sqlite3_io_methods methods = madeMethods(*opened.real()->pMethods);
    opened.pending = new Pending{{}, contentOf(opened.real())};
    opened.base.pMethods = &methods;
    state().files.insert(&opened);
    return code;
  }

  static sqlite3_io_methods madeMethods(sqlite3_io_methods m) {
    m.iVersion = 2;  // no mapped memory but that of the index of the log
    m.xClose = [](sqlite3_file* f) {
      state().files.erase(&self(f));
      delete self(f).pending;
      return self(f).real()->pMethods->xClose(self(f).real());
    };
    m.xRead = [](sqlite3_file* f, void* data, int size, sqlite3_int64 offset) {
      return self(f).real()->pMethods->xRead(self(f).real(), data, size, offset);
    };
    m.xWrite = [](sqlite3_file* f, const void* data, int size, sqlite3_int64 offset) {
      countWrite();
      self(f).pending->writes.push_back(
          {offset, {static_cast<const char*>(data), static_cast<std::size_t>(size)}, false});
      return self(f).real()->pMethods->xWrite(self(f).real(), data, size, offset);
    };
    m.xTruncate = [](sqlite3_file* f, sqlite3_int64 size) {
      countWrite();
      self(f).pending->writes.push_back({size, {}, true});
      return self(f).real()->pMethods->xTruncate(self(f).real(), size);
    };
    m.xSync = [](sqlite3_file* f, int flags) {
      countWrite();
      const int code = self(f).real()->pMethods->xSync(self(f).real(), flags);
      *self(f).pending = {{}, contentOf(self(f).real())};
      return code;
    };
    m.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
      return self(f).real()->pMethods->xFileSize(self(f).real(), size);
    };
    m.xLock = [](sqlite3_file* f, int lock) { return self(f).real()->pMethods->xLock(self(f).real(), lock); };
    m.xUnlock = [](sqlite3_file* f, int lock) { return self(f).real()->pMethods->xUnlock(self(f).real(), lock); };
    m.xCheckReservedLock = [](sqlite3_file* f, int* held) {
      return self(f).real()->pMethods->xCheckReservedLock(self(f).real(), held);
    };
    m.xFileControl = [](sqlite3_file* f, int what, void* value) {
      return self(f).real()->pMethods->xFileControl(self(f).real(), what, value);
    };
    m.xSectorSize = [](sqlite3_file* f) { return self(f).real()->pMethods->xSectorSize(self(f).real()); };
    m.xDeviceCharacteristics = [](sqlite3_file*) { return 0; };
    m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** memory) {
      return self(f).real()->pMethods->xShmMap(self(f).real(), page, size, extend, memory);
    };
    m.xShmLock = [](sqlite3_file* f, int offset, int n, int flags) {
      return self(f).real()->pMethods->xShmLock(self(f).real(), offset, n, flags);
    };
    m.xShmBarrier = [](sqlite3_file* f) { self(f).real()->pMethods->xShmBarrier(self(f).real()); };
    m.xShmUnmap = [](sqlite3_file* f, int remove) {
      return self(f).real()->pMethods->xShmUnmap(self(f).real(), remove);
    };
    return m;
  }

  static void countWrite() {
    if (state().num_writes++ != state().fatal_write) return;
    RandomStream random(state().seed);
    for (File* file : state().files) {
      std::string content = file->pending->before;
      for (const Write& write : file->pending->writes) {
        if (random.uniform() < 0.5) continue;
        const auto offset = static_cast<std::size_t>(write.offset);
        if (write.truncates || content.size() < offset + write.data.size()) content.resize(offset + write.data.size());
        content.replace(offset, write.data.size(), write.data);
      }
      replaceContent(file->real(), content);
    }
    ::_exit(9);
  }
};

}  // namespace pcl_symmetry::test
