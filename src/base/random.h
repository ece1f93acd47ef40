// Random numbers keyed by (seed, stage, element): the same whatever the order or thread that asks for them.
#pragma once

#include <cstdint>

namespace matstruct {

/// A stream of random numbers (splitmix64, Steele et al. 2014) that depends only on its key.
class KeyedRandom {
 public:
  KeyedRandom(std::uint64_t seed, std::uint64_t stage, std::uint64_t element)
      : state_(mix(mix(mix(seed) + stage) + element)) {}

  std::uint64_t next() { return mix(state_ += kStep); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15;
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

}  // namespace matstruct
