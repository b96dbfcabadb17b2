/* Which of its dense kernels OpenBLAS runs. It knows the processors of its own time; on one of later make it falls back to those of 2004 (Prescott), and
   runs in space took up to 1.7 times as long. Whatever serves AVX2 or AVX-512 serves the kernels that OpenBLAS has for these: named by its own variable, which
   it reads where it is begun anew. What the user names there stands. */
#include "appimpl.h"

#include <stdlib.h>
#include <string.h>

extern char *openblas_get_corename(void) __attribute__((weak));
extern void  gotoblas_dynamic_init(void) __attribute__((weak));
extern void  gotoblas_dynamic_quit(void) __attribute__((weak));

/* OpenBLAS' name for the kernels that this processor can run; NULL: those of old. */
static const char *Kernels_Private(void)
{
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return NULL;
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl")
             ? "SkylakeX"
             : "Haswell";
#else
  return NULL;
#endif
}

void AppKernels(void)
{
  static const char VARIABLE[] = "OPENBLAS_CORETYPE";

  if (!openblas_get_corename || !gotoblas_dynamic_init || !gotoblas_dynamic_quit) return; /* another BLAS, or kernels of one processor */
  if (getenv(VARIABLE) || strcmp(openblas_get_corename(), "Prescott") || !Kernels_Private()) return;
  if (setenv(VARIABLE, Kernels_Private(), 1)) return;
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(VARIABLE); /* programs that this one starts choose for themselves */
}
