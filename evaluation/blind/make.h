/// `musclesim blind make`: draws plants with withheld causes, records them and seals the key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace musclesim::blind {

struct MakeOptions {
  int count = 120;                                              ///< cases on the robots in turn
  std::vector<std::string> robots = {"rig", "elbow", "wrist"};  ///< names or robot files; one may be named more than once
  int arm_count = 12;                                           ///< further cases on the arm
  std::uint64_t seed = 1;
  double duration_s = 6;           ///< of each recording; half of it on the arm and other robots of many muscles
  std::vector<std::string> kinds;  ///< names of kinds(), with equal odds; empty: all by their shares
  std::vector<std::string>
      causes;                  ///< ids of the catalogue that plants may have; empty: all. Open plants have causes outside the catalogue
  bool exact_numbers = false;  ///< whether the plants have the model's numbers
  int job_count = 0;           ///< threads; 0: one per core. The cases do not depend on it
  std::string commit;          ///< of the sources, for the seal; may be empty
  std::function<void(int done, int count)> progress = [](int, int) {};
  std::function<bool()> interrupted = [] { return false; };
};

/// Writes DIR/caseNNN/r1..r4.csv and .json, DIR/seal.json, and the key to `key_folder` under a random name. The seal holds the key's name
/// and SHA-256, the SHA-256 of all recordings, the seed and the program. The same seed and options give the same bits except for the key's
/// name. Returns the key's path, or none if interrupted; the same call then continues with the finished cases. Throws BadParameter for a
/// DIR that holds anything else, and for a key folder inside DIR or so near that `blind run` would find the key.
std::filesystem::path make(const std::filesystem::path& folder, const std::filesystem::path& key_folder, const MakeOptions& options);

}  // namespace musclesim::blind
