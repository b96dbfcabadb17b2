/* Open-addressing hash of entity keys. */
#include "forestimpl.h"

const PetscInt ForestPow3[4]       = {1, 3, 9, 27};
const int8_t   ForestTensorDim[27] = {0, 1, 0, 1, 2, 1, 0, 1, 0, 1, 2, 1, 2, 3, 2, 1, 2, 1, 0, 1, 0, 1, 2, 1, 0, 1, 0};

PetscErrorCode ForestHashCreate(PetscInt expected, EntityHash *hash)
{
  size_t size = 16;

  PetscFunctionBegin;
  while (size < 2 * (size_t)expected) size *= 2;
  hash->mask  = size - 1;
  hash->count = 0;
  PetscCall(PetscMalloc2(size, &hash->key, size, &hash->value));
  for (size_t i = 0; i < size; ++i) hash->value[i] = -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestHashDestroy(EntityHash *hash)
{
  PetscFunctionBegin;
  PetscCall(PetscFree2(hash->key, hash->value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscBool IsKey_Private(EntityKey a, EntityKey b)
{
  return (PetscBool)(a.lo == b.lo && a.hi == b.hi && a.what == b.what);
}

/* Slot of the key, or the empty slot where it belongs. Multiplicative mixing: low ends differ only in few high bits. */
static inline size_t HashSlot_Private(const EntityHash *hash, EntityKey key)
{
  uint64_t h = (key.lo ^ (key.what * 0x9e3779b97f4a7c15ULL) ^ (key.hi * 0xbf58476d1ce4e5b9ULL)) * 0xd6e8feb86659fd93ULL;
  size_t   slot;

  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93ULL;
  h ^= h >> 32;
  slot = (size_t)h & hash->mask;
  while (hash->value[slot] >= 0 && !IsKey_Private(hash->key[slot], key)) slot = (slot + 1) & hash->mask;
  return slot;
}

static PetscErrorCode HashGrow_Private(EntityHash *hash)
{
  EntityHash bigger;

  PetscFunctionBegin;
  PetscCall(ForestHashCreate((PetscInt)(hash->mask + 1), &bigger));
  for (size_t i = 0; i <= hash->mask; ++i) {
    if (hash->value[i] < 0) continue;
    const size_t slot  = HashSlot_Private(&bigger, hash->key[i]);
    bigger.key[slot]   = hash->key[i];
    bigger.value[slot] = hash->value[i];
  }
  bigger.count = hash->count;
  PetscCall(ForestHashDestroy(hash));
  *hash = bigger;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForestHashInsert(EntityHash *hash, EntityKey key, PetscInt *value, PetscBool *added)
{
  size_t slot = HashSlot_Private(hash, key);

  PetscFunctionBeginHot;
  *added = PETSC_FALSE;
  if (hash->value[slot] < 0) {
    *added            = PETSC_TRUE;
    hash->key[slot]   = key;
    hash->value[slot] = hash->count++;
    *value            = hash->value[slot];
    if (2 * (size_t)hash->count > hash->mask) PetscCall(HashGrow_Private(hash));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  *value = hash->value[slot];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscInt ForestHashFind(const EntityHash *hash, EntityKey key)
{
  return hash->value[HashSlot_Private(hash, key)];
}

void ForestSubClosure(PetscInt index, int8_t code, const PetscInt closure[], const int8_t orientation[], PetscInt sub_closure[], int8_t sub_orientation[])
{
  const PetscInt n = ForestTensorDim[index];
  PetscInt       stride[2], step[2] = {0, 0};

  for (PetscInt i = 0, j = 0; i < 3; ++i)
    if ((index / ForestPow3[i]) % 3 == 1 && j < n) stride[j++] = ForestPow3[i];
  /* Move in the owner's table for one step along each axis of the entity's frame. */
  for (PetscInt j = 0; j < n; ++j) {
    const PetscInt f = ForestFrameAxis(n, code, j);
    step[f]          = ForestFrameReversed(code, f) ? -stride[j] : stride[j];
  }
  for (PetscInt u = 0; u < ForestPow3[n]; ++u) {
    const PetscInt t[2] = {u % 3, u / 3};
    const PetscInt from = index + (t[0] - 1) * step[0] + (n == 2 ? (t[1] - 1) * step[1] : 0);
    sub_closure[u]      = closure[from];
    sub_orientation[u]  = 0;
    if (n == 2 && ForestTensorDim[u] == 1) sub_orientation[u] = (int8_t)(orientation[from] ^ ForestFrameReversed(code, t[0] == 1 ? 0 : 1));
  }
}
