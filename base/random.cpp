#include "musclesim/base/random.h"

#include <cmath>
#include <numbers>

namespace musclesim {

namespace {

/// FNV-1a hash of a name, mixed with the seed by the finaliser of SplitMix64 (Steele, Lea and Flood, 2014).
std::uint64_t mix(std::uint64_t seed, std::string_view owner) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (char letter : owner) hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ULL + hash;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view owner) : engine_(mix(seed, owner)) {}

double RandomStream::uniform(double low, double high) {
  const double unit = static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  return low + (high - low) * unit;
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace musclesim
