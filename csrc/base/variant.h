/* What sources share that are compiled once for each instruction set (cmake/TrbKernels.cmake), and tables of what was built. */
#ifndef TRB_BASE_VARIANT_H
#define TRB_BASE_VARIANT_H

#ifndef TRB_KERNEL_VARIANT
#define TRB_KERNEL_VARIANT scalar
#endif
#define TRB_JOIN_(a, b) a##b
#define TRB_JOIN(a, b) TRB_JOIN_(a, b)

/* Before a loop whose results may be written over its inputs: entries are read before they are written, but the compiler has to be told. */
#if defined(__GNUC__) && !defined(__clang__)
#define TRB_LANES _Pragma("GCC ivdep")
#else
#define TRB_LANES
#endif

/* Numbers side by side, as many as a register of the instruction set holds. Compilers take vectors of more numbers apart by way of the memory, which costs
 * several times the sums themselves. */
#if defined(__AVX512F__)
#define TRB_WIDE 8
#elif defined(__AVX__)
#define TRB_WIDE 4
#else
#define TRB_WIDE 2
#endif
typedef double trb_wide __attribute__((vector_size(TRB_WIDE * sizeof(double))));

/* Variants that were built, slowest first: X(name). */
#ifdef TRB_HAVE_AVX2
#define TRB_AVX2(X) X(avx2)
#else
#define TRB_AVX2(X)
#endif
#ifdef TRB_HAVE_AVX512
#define TRB_AVX512(X) X(avx512)
#else
#define TRB_AVX512(X)
#endif
#define TRB_VARIANTS(X) X(scalar) X(base) TRB_AVX2(X) TRB_AVX512(X)

#endif
