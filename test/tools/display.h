/// A display for tests that draw.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

/// Starts the test program again within xvfb-run where there is no display, as the tools do.
inline void findDisplayForTest() {
  if (std::getenv("DISPLAY")) return;
  std::vector<std::string> words = {"xvfb-run", "-a"};
  std::ifstream line("/proc/self/cmdline", std::ios::binary);
  for (std::string word; std::getline(line, word, '\0');) words.push_back(word);
  std::vector<char*> command;
  for (std::string& word : words) command.push_back(word.data());
  command.push_back(nullptr);
  ::execvp(command[0], command.data());
}
