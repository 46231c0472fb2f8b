#pragma once

/// Compiles a plain loop for several instruction sets; the fastest that the processor supports is picked at run time.
/// Sanitized builds have one version only: their run-time library is not ready yet when the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define PCL_SYMMETRY_MULTIVERSION __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define PCL_SYMMETRY_MULTIVERSION
#endif
