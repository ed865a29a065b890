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
