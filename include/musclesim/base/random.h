/// Seeded random streams, one per owner, all derived from the run's seed: a new owner does not change the numbers of the others.
#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace musclesim {

/// A stream of random numbers. The same seed and owner give the same numbers on every platform with IEEE doubles.
class RandomStream {
 public:
  /// `owner` names the consumer ("asm.attractors"); different owners of one seed get unrelated streams.
  RandomStream(std::uint64_t seed, std::string_view owner);
  /// Uniform in [low, high).
  double uniform(double low = 0.0, double high = 1.0);
  /// Normal with mean 0 and standard deviation 1 (Box and Muller, 1958).
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace musclesim
