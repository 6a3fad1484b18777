#pragma once

// Functions whose loops are compiled twice, for vectors of two numbers and for the four of newer processors,
// among which the program chooses where it runs. Results are the same to the last bit.

#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define ARCSLIP_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define ARCSLIP_WIDE
#endif
