/// SIMD kernels: loops over long rows of numbers in the widest registers of the processor.
///
/// Functions marked MUSCLESIM_SIMD are compiled several times; the loader selects the version that fits the processor. All versions do the
/// same operations on the same numbers in the same order (sums across a register have a fixed order, and products and sums are not
/// contracted), so the result does not depend on the processor to the last bit. Sanitizers are not ready yet when the loader selects.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define MUSCLESIM_SIMD __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define MUSCLESIM_SIMD
#endif

namespace musclesim::chain {

/// A tile has eight by eight numbers in column-major order. l is a unit lower triangle; only the entries below its diagonal are used.
inline constexpr int tile_width = 8, tile_size = tile_width * tile_width;

void clear(double* numbers, int count);
/// Factorises a = L D L^T: writes L below the diagonal of a and the reciprocals of D to per_pivots. The rest of a is undefined afterwards.
void factoriseTile(double* a, double* per_pivots);
/// scaled = a L^-T = B D,  a = B
void solveTile(double* a, double* scaled, const double* l, const double* per_pivots);
/// targets[i] -= left[i] right^T; `left` points to consecutive tiles.
void subtractTileProducts(double* const* targets, const double* left, const double* right, int count);
/// x <- L^-1 x and L^-T x
void solveLower(const double* l, double* x);
void solveUpper(const double* l, double* x);
/// y -= a x and y -= a^T x
void subtractProduct(double* y, const double* a, const double* x);
void subtractTransposed(double* y, const double* a, const double* x);

/// The functions below work on y, six rows of eight numbers. l is a lower triangle of six by six numbers in column-major order, per_pivot
/// the reciprocals of its diagonal; the columns before `first_coupled` (0 or 3) are zero below the diagonal.
/// y <- l^-1 y
void solveSixRows(double y[6][tile_width], const double* l, const double per_pivot[6], int first_coupled);
/// tile += left^T right, for the columns whose bits are set
void addTileProducts(double* tile, const double left[6][tile_width], const double right[6][tile_width], unsigned columns);
/// x -= y^T factors
void subtractCombination(double* x, const double y[6][tile_width], const double factors[6]);
/// sums += y x
void addProduct(double sums[6], const double y[6][tile_width], const double* x);

}  // namespace musclesim::chain
