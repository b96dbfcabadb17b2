/* A checksum: Fowler, Noll and Vo's hash 1a of 64 bits. Every step is one to one, so that a single byte that differs always shows. */
#include "base.h"

uint64_t HashBytes(uint64_t seed, const void *bytes, size_t num)
{
  const unsigned char *b    = bytes;
  uint64_t             hash = seed ? seed : UINT64_C(0xcbf29ce484222325);

  for (size_t i = 0; i < num; ++i) hash = (hash ^ b[i]) * UINT64_C(0x100000001b3);
  return hash;
}
