/// Loops over long rows of numbers, in the widest registers that the processor has.
///
/// Functions marked MUSCLESIM_WIDE are compiled several times; which one runs is decided when the program is loaded. All do the same
/// operations on the same numbers in the same order (nothing is summed across a register, and products and sums are not contracted), so
/// the bits do not depend on the processor.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define MUSCLESIM_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define MUSCLESIM_WIDE
#endif

namespace musclesim::chain {

/// target -= factor[0] column[0] + factor[1] column[1] + ..., four columns at a time; `group_count` groups of four.
void subtractColumns(double* target, const double* const* columns, const double* factors, int group_count, int count);

/// result = factor[0] row[0] + ... + factor[5] row[5]
void combineSixRows(double* result, const double* const rows[6], const double factors[6], int count);

}  // namespace musclesim::chain
