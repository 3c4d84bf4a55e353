/// Loops over long rows of numbers, in the widest registers that the processor has.
///
/// Functions marked MUSCLESIM_WIDE are compiled several times; which one runs is decided when the program is loaded. All do the same
/// operations on the same numbers in the same order (nothing is summed across a register but in a fixed order, and products and sums are
/// not contracted), so the bits do not depend on the processor.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define MUSCLESIM_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define MUSCLESIM_WIDE
#endif

namespace musclesim::chain {

/// result = factor[0] row[0] + ... + factor[5] row[5]; rows and result must have room for a multiple of eight numbers.
void combineSixRows(double* result, const double* const rows[6], const double factors[6], int count);

/// Tiles: eight by eight numbers, one column after another. l is a unit lower triangle, of which only what is below the diagonal is used.
inline constexpr int tile_width = 8, tile_size = tile_width * tile_width;

/// a = L D L^T: below the diagonal of a stands L; above it nothing of use.
void factoriseTile(double* a, double* pivots);
/// scaled = a L^-T = B D,  a = B
void solveTile(double* a, double* scaled, const double* l, const double* pivots);
/// targets[i] -= left[i] right^T; `left` are tiles in a row.
void subtractTileProducts(double* const* targets, const double* left, const double* right, int count);
/// x <- L^-1 x and L^-T x
void solveLower(const double* l, double* x);
void solveUpper(const double* l, double* x);
/// y -= a x and y -= a^T x
void subtractProduct(double* y, const double* a, const double* x);
void subtractTransposed(double* y, const double* a, const double* x);

}  // namespace musclesim::chain
