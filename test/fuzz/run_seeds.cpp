/// The main function of targets in builds without libFuzzer: runs the seeds of a folder as they are, and with bytes
/// changed at random for some seconds. It finds less than libFuzzer, which knows what the code has done.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "core/base/random.h"
#include "fuzz/byte_source.h"

namespace {

using pcl_symmetry::RandomStream;
using Bytes = std::vector<std::uint8_t>;

constexpr int kMostChanges = 8;  // of a seed

std::vector<Bytes> seedsOf(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// Changes, removes or repeats bytes, or turns digits into other ones.
void change(Bytes& bytes, RandomStream& random) {
  if (bytes.empty()) return;
  const auto at = [&] { return static_cast<std::ptrdiff_t>(random.below(bytes.size())); };
  const std::ptrdiff_t i = at(), j = at();
  switch (random.below(5)) {
    case 0:
      bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(random.below(256));
      break;
    case 1:
      bytes[static_cast<std::size_t>(i)] ^= static_cast<std::uint8_t>(1u << random.below(8));
      break;
    case 2:
      bytes.erase(bytes.begin() + std::min(i, j), bytes.begin() + std::max(i, j));
      break;
    case 3: {
      const Bytes part(bytes.begin() + std::min(i, j), bytes.begin() + std::max(i, j));
      bytes.insert(bytes.begin() + at(), part.begin(), part.end());
      break;
    }
    default:
      if (std::isdigit(bytes[static_cast<std::size_t>(i)]))
        bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>('0' + random.below(10));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: " << argv[0] << " SEEDS SECONDS\nRuns the files of the folder SEEDS, then changes of them.\n";
    return 2;
  }
  const std::vector<Bytes> seeds = seedsOf(argv[1]);
  if (seeds.empty()) {
    std::cerr << argv[1] << ": holds no seed\n";
    return 2;
  }
  for (const Bytes& seed : seeds) LLVMFuzzerTestOneInput(seed.data(), seed.size());
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(std::stod(argv[2]));
  RandomStream random(1);
  std::size_t num_runs = 0;
  for (; std::chrono::steady_clock::now() < end; ++num_runs) {
    Bytes bytes = seeds[random.below(seeds.size())];
    for (std::uint64_t i = 1 + random.below(kMostChanges); i > 0; --i) change(bytes, random);
    // Kept, so that a run that ends the program can be done again.
    std::ofstream("last_input", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::cout << seeds.size() << " seeds and " << num_runs << " changes of them\n";
  return 0;
}
