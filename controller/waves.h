/// The shapes of test signals over time: pure functions that stay within -1 .. 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace musclesim {

/// Triangle over `cycles` (time over period): -1 at whole numbers, +1 half-way between, straight in between.
double triangleWave(double cycles);

/// Square wave over `cycles`: +1 in the first half of each cycle, -1 in the second.
double squareWave(double cycles);

/// Sine with a frequency that moves from f_0 to f_1 in T and then stays:
///     s(t) = sin(2 pi c(t)),   c the cycles so far
///     linear:       c = f_0 t + (f_1 - f_0) t^2 / (2 T)
///     logarithmic:  c = f_0 T (k^(t/T) - 1) / ln k,   k = f_1 / f_0          (equal times per octave)
/// and for t > T  c = c(T) + f_1 (t - T). t, T in s; f in Hz, above 0.
struct Chirp {
  double from_Hz, to_Hz, sweep_s;
  bool logarithmic;
  double cycles(double time_s) const;
  double at(double time_s) const;
};

/// Stairs of `step_count` equal steps from -1 up to +1 and down again; every level is held for hold_s, the ends once.
///     s = -1 + 2 j / n,   j = n - |k mod 2 n - n|,   k = floor(t / hold)
double stairsWave(double time_s, double hold_s, int step_count);

/// Nested loops about 0, the largest first, run through at a constant rate: loop m = 0 .. n - 1 has the amplitude A_m = 1 - m / n and lasts
/// A_m T; it goes 0, +A_m, -A_m, 0. After the smallest loop the largest follows again. They show the minor loops of a hysteresis.
///     s = A_m triangle((t - t_m) / (A_m T)),   t_m = T (A_0 + ... + A_(m-1))
double reversalsWave(double time_s, double period_s, int loop_count);

/// Pseudo-random binary sequence of maximal length 2^n - 1: +1 or -1, from a shift register of n bits with the feedback
///     b_k = b_(k-n) xor b_(k-m) [xor two further bits]
/// of a primitive polynomial. Over one length each non-zero register content occurs once, so there is one +1 more than -1, and the
/// autocorrelation is -1/(2^n - 1) at all shifts but 0. Source: Ljung, System Identification, 2nd edition, Section 13.3; the polynomials
/// are those of the usual tables (tests check that the lengths are maximal).
class BinarySequence {
 public:
  static constexpr int smallest_order = 2, largest_order = 12;
  /// Begins at the `offset`-th bit, modulo the length. Throws BadParameter for an order out of range.
  explicit BinarySequence(int order, std::uint64_t offset = 0);
  long length() const { return static_cast<long>(bits_.size()); }
  /// The k-th value, k >= 0.
  double at(long k) const;

 private:
  std::vector<bool> bits_;
  std::size_t offset_;
};

/// Sum of cosines at all multiples of 1/T within a band, of equal amplitude, scaled so that the largest |s| is 1:
///     s(t) = g sum_{i=1..N} cos(2 pi m_i t / T + phi_i)
/// With the phases of Schroeder (1970), phi_i = -pi i (i - 1) / N, the peaks are low for the energy. t, T in s.
class Multisine {
 public:
  /// The multiples of 1/T in low .. high. Throws BadParameter if there are none or too many.
  static std::vector<int> harmonics(double low_Hz, double high_Hz, double period_s);
  static std::vector<double> schroederPhases(std::size_t count);

  Multisine(std::vector<int> harmonics, std::vector<double> phases, double period_s);
  double at(double time_s) const;

 private:
  double sum(double time_s) const;
  /// The unscaled sum at `count` even times of a period.
  std::vector<double> samples(std::size_t count) const;
  /// The largest |sum| at 64 points of each cycle of the highest frequency.
  double peak() const;
  std::vector<int> harmonics_;
  std::vector<double> phases_;
  double period_s_, scale_ = 1;
};

}  // namespace musclesim
