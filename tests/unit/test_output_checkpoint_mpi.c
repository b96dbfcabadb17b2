/* A checkpoint gives back what it was made of, to the last bit, from memory and from the file, with leaves owned by other ranks; scenes and meshes it does not
   belong to are refused, and so is a file of which a bit or the end is missing. */
#include "outputimpl.h"

#include "directory.h"
#include "patchfixture.h"
#include <unistd.h>

static char        path[PETSC_MAX_PATH_LEN];
static PetscMPIInt rank, size;

static PetscBool IsPattern(const PackField *field)
{
  return (PetscBool)!strncmp(field->name, "pattern.", 8);
}

/* Entries that the matrix has room for, of all ranks. */
static PetscReal Room(Problem problem)
{
  MatInfo info;
  Mat     A;

  OK(ProblemGetMatrix(problem, &A));
  OK(MatGetInfo(A, MAT_GLOBAL_SUM, &info));
  return info.nz_used;
}

/* A mixed patch on a mesh with hanging nodes and mixed orders, its state filled at random: the same numbers whatever the partition. After a move contact has
   been given room in the matrix. */
static void Begin(Patch *p, PetscInt moves)
{
  const CheckpointNumber one = {"one", 1. / 3};
  Checkpoint             c;
  int8_t                *orders;
  PetscReal              jump;
  PetscBool              bad;

  box_random_state = 88172645463325252ULL;
  PatchScene(p, 2, MODEL_PLANE_STRAIN, KINEMATICS_FINITE, FORMULATION_MIXED);
  p->boundaries[LEFT].fix[0]     = PETSC_FALSE;
  p->boundaries[LEFT].fix_normal = PETSC_TRUE; /* nodes with frames */
  p->forest                      = PatchForest((const PetscInt[2]){3, 5});
  OK(ProblemInitialOrders(&p->data, p->forest, &orders));
  PatchProblem(&p->data, p->forest, orders, &p->problem, &p->state);
  OK(ProblemJump(p->problem));
  OK(PetscFree(orders));
  for (PetscInt i = 0; i < moves; ++i) {
    OK(ProblemSearch(p->problem, p->state.x));
    PatchMove(p, 3, (PetscBool)(i % 2), PETSC_TRUE);
  }
  OK(ProblemSearch(p->problem, p->state.x));
  if (moves) OK(ProblemTangent(p->problem, p->state.x, NULL, NULL, &bad));
  OK(CheckpointCreate(p->problem, &p->state, 1, &one, "", &c));
  for (PetscInt f = 0; f < c->pack.num; ++f) {
    PetscInt lo, hi;
    if (IsPattern(&c->pack.field[f])) continue;
    OK(VecGetOwnershipRange(c->pack.field[f].values, &lo, &hi));
    for (PetscInt i = lo; i < hi; ++i) OK(VecSetValue(c->pack.field[f].values, i, 0.01 * PetscSinReal(1.7 * i + f), INSERT_VALUES));
    OK(VecAssemblyBegin(c->pack.field[f].values));
    OK(VecAssemblyEnd(c->pack.field[f].values));
  }
  OK(TransferUnpack(p->problem, &c->pack, &p->state, &jump));
  assert_true(jump > 1e-3); /* supports do not follow random values */
  OK(CheckpointDestroy(&c));
}

static Checkpoint Copy(const Patch *p)
{
  const CheckpointNumber numbers[] = {{"dt", 1. / 3}, {"steps", 12345678}};
  Checkpoint             c;

  OK(CheckpointCreate(p->problem, &p->state, 2, numbers, "why it ended", &c));
  return c;
}

/* State and forest of c are those of p. */
static void Same(const Patch *p, Checkpoint c, PetscInt moves, PetscBool turned)
{
  const ForestTables *t, *u;
  const int8_t       *orders;
  Forest              forest;
  Problem             problem;
  State               state;
  Pack                a, b;
  PetscReal           value, room;
  PetscBool           equal;

  OK(CheckpointForest(c, p->forest, &forest));
  t = ForestGetTables(p->forest);
  u = ForestGetTables(forest);
  assert_int_equal(t->num_leaves, u->num_leaves);
  for (PetscInt l = 0; l < t->num_leaves; ++l) assert_int_equal(u->leaf_rank[l], turned ? size - 1 - t->leaf_rank[l] : t->leaf_rank[l]);
  OK(CheckpointOrders(c, &orders));
  assert_memory_equal(orders, p->state.leaf_order, (size_t)t->num_leaves);
  PatchProblem(&p->data, forest, orders, &problem, &state);
  OK(ProblemJump(problem));
  room = Room(problem);
  OK(CheckpointState(c, problem, &state));
  assert_true(state.t == p->state.t);
  assert_true((Room(problem) > room) == (moves > 0));
  if (!turned) {
    assert_true(Room(problem) == Room(p->problem));
    OK(VecEqual(state.x, p->state.x, &equal));
    assert_true(equal);
    assert_memory_equal(state.pressure, p->state.pressure, sizeof(PetscReal) * (size_t)state.num_pressure);
  }
  OK(TransferPack(p->problem, &p->state, &a));
  OK(TransferPack(problem, &state, &b));
  assert_int_equal(a.num, 8);
  for (PetscInt f = 0; f < a.num; ++f) {
    PetscInt num;
    OK(VecGetSize(a.field[f].values, &num));
    assert_true((num > 5) == (f == 0 || f == 1 || f >= 6)); /* displacement, pressure, multiplier, pattern; an elastic scene has no others */
    OK(VecEqual(a.field[f].values, b.field[f].values, &equal));
    assert_true(equal);
  }
  OK(PackDestroy(&a));
  OK(PackDestroy(&b));
  OK(CheckpointGetNumber(c, "dt", &value));
  assert_true(value == 1. / 3);
  OK(CheckpointGetNumber(c, "steps", &value));
  assert_true(value == 12345678);
  assert_int_equal(CheckpointGetNumber(c, "none", &value), MORTISE_ERR_INPUT);
  assert_string_equal(CheckpointNote(c), "why it ended");
  OK(StateDestroy(&state));
  OK(ProblemDestroy(&problem));
  OK(ForestDestroy(&forest));
}

static void GivesBack(void **unused)
{
  for (PetscInt moves = 0; moves <= 2; moves += 2) {
    Patch      p;
    Checkpoint c, read;
    char       temporary[PETSC_MAX_PATH_LEN];
    Begin(&p, moves);
    c = Copy(&p);
    snprintf(temporary, sizeof(temporary), "%s.tmp", path);
    Same(&p, c, moves, PETSC_FALSE);
    OK(CheckpointWrite(c, path));
    if (rank == 0) assert_int_not_equal(access(temporary, F_OK), 0);
    OK(CheckpointRead(PETSC_COMM_WORLD, path, &read));
    OK(CheckpointCheck(read, &p.data, p.forest));
    Same(&p, read, moves, PETSC_FALSE);
    for (PetscInt l = 0; l < read->num_leaves; ++l) read->owner[l] = size - 1 - read->owner[l];
    Same(&p, read, moves, PETSC_TRUE);
    OK(CheckpointDestroy(&read));
    OK(CheckpointDestroy(&c));
    PatchDestroy(&p);
  }
}

/* Any amount of numbers of the caller, in memory and from a file; none. */
static void KeepsValues(void **unused)
{
  const PetscReal given[] = {1, -2, 1. / 3, 4, 5e300, 6, 7};
  PetscReal      *values;
  PetscInt        num;
  Patch           p;
  Checkpoint      c, read;

  Begin(&p, 0);
  c = Copy(&p);
  OK(CheckpointGetValues(c, &num, &values));
  assert_int_equal(num, 0);
  OK(CheckpointPutValues(c, 7, given));
  OK(CheckpointWrite(c, path));
  OK(CheckpointRead(PETSC_COMM_WORLD, path, &read));
  for (PetscInt i = 0; i < 2; ++i) {
    OK(CheckpointGetValues(i ? read : c, &num, &values));
    assert_int_equal(num, 7);
    assert_memory_equal(values, given, sizeof(given));
    OK(PetscFree(values));
  }
  Same(&p, read, 0, PETSC_FALSE);
  OK(CheckpointDestroy(&read));
  OK(CheckpointDestroy(&c));
  PatchDestroy(&p);
}

static void RefusesOthers(void **unused)
{
  Patch      p;
  Checkpoint c;
  Forest     other;
  Problem    problem;
  State      state;

  Begin(&p, 0);
  c = Copy(&p);
  p.material.parameter[0] *= 1 + 1e-9; /* E */
  assert_int_equal(CheckpointCheck(c, &p.data, p.forest), MORTISE_ERR_INPUT);
  p.material.parameter[0] /= 1 + 1e-9;
  p.contact.full = PETSC_TRUE;
  assert_int_equal(CheckpointCheck(c, &p.data, p.forest), MORTISE_ERR_INPUT);
  p.contact.full = PETSC_FALSE;
  p.data.num_contacts--;
  assert_int_equal(CheckpointCheck(c, &p.data, p.forest), MORTISE_ERR_INPUT);
  p.data.num_contacts++;
  p.data.adapt.repeat = REPEAT_PATH;
  assert_int_equal(CheckpointCheck(c, &p.data, p.forest), MORTISE_ERR_INPUT);
  p.data.adapt.repeat = REPEAT_STEP;
  p.data.load.end     = 2; /* may change */
  OK(CheckpointCheck(c, &p.data, p.forest));
  other = PatchForest((const PetscInt[2]){5, 3});
  assert_int_equal(CheckpointCheck(c, &p.data, other), MORTISE_ERR_INPUT);
  OK(ForestDestroy(&other));

  PatchProblem(&p.data, p.forest, p.state.leaf_order, &problem, &state); /* its motion is not applied */
  assert_int_equal(CheckpointState(c, problem, &state), MORTISE_ERR_INPUT);
  OK(StateDestroy(&state));
  OK(ProblemDestroy(&problem));
  OK(CheckpointDestroy(&c));
  PatchDestroy(&p);
}

/* First rank: the file's bytes, num of them, one of them changed. */
static void Put(const char *to, const unsigned char *bytes, size_t num, size_t at, int flip)
{
  FILE *file = rank ? NULL : fopen(to, "w");

  if (!file) return;
  assert_int_equal(fwrite(bytes, 1, num, file), num);
  if (flip) {
    fseek(file, (long)at, SEEK_SET);
    fputc(bytes[at] ^ flip, file);
  }
  fclose(file);
}

static void RefusesDamage(void **unused)
{
  Patch          p;
  Checkpoint     c;
  unsigned char *bytes = NULL;
  long           num   = 0;
  char           hurt[PETSC_MAX_PATH_LEN];

  Begin(&p, 1);
  c = Copy(&p);
  OK(CheckpointWrite(c, path));
  OK(CheckpointDestroy(&c));
  PatchDestroy(&p);
  snprintf(hurt, sizeof(hurt), "%s/hurt.h5", directory);
  if (rank == 0) {
    FILE *file = fopen(path, "r");
    fseek(file, 0, SEEK_END);
    num   = ftell(file);
    bytes = malloc((size_t)num);
    rewind(file);
    assert_int_equal(fread(bytes, 1, (size_t)num, file), num);
    fclose(file);
  }
  assert_int_equal(MPI_Bcast(&num, 1, MPI_LONG, 0, PETSC_COMM_WORLD), 0);
  for (PetscInt i = 0; i < 60; ++i) {
    const size_t at  = i < 20 ? (size_t)BoxRandom(CHECKPOINT_SEAL) : (size_t)BoxRandom((PetscInt)num);
    const int    bit = 1 << BoxRandom(8);
    Put(hurt, bytes, (size_t)num, at, bit);
    assert_int_equal(CheckpointVerify(PETSC_COMM_WORLD, hurt), MORTISE_ERR_INPUT);
    Put(hurt, bytes, at, 0, 0);
    assert_int_equal(CheckpointVerify(PETSC_COMM_WORLD, hurt), MORTISE_ERR_INPUT);
  }
  Put(hurt, bytes, (size_t)num, 0, 0);
  OK(CheckpointVerify(PETSC_COMM_WORLD, hurt));
  free(bytes);
}

/* A seal that holds says nothing of the numbers behind it. */
static void RefusesNonsense(void **unused)
{
  Patch      p;
  Checkpoint c, read;
  char       nonsense[PETSC_MAX_PATH_LEN];

  Begin(&p, 1);
  snprintf(nonsense, sizeof(nonsense), "%s/nonsense.h5", directory);
  c           = Copy(&p);
  c->owner[0] = size;
  OK(CheckpointWrite(c, nonsense));
  assert_int_equal(CheckpointRead(PETSC_COMM_WORLD, nonsense, &read), MORTISE_ERR_INPUT);
  c->owner[0] = 0;
  c->order[0] = MORTISE_MAX_ORDER + 1;
  OK(CheckpointWrite(c, nonsense));
  assert_int_equal(CheckpointRead(PETSC_COMM_WORLD, nonsense, &read), MORTISE_ERR_INPUT);
  OK(CheckpointDestroy(&c));
  PatchDestroy(&p);
}

static int Start(void **unused)
{
  return DirectoryCreate(unused) || snprintf(path, sizeof(path), "%s/checkpoint.h5", directory) < 0;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(GivesBack), cmocka_unit_test(KeepsValues), cmocka_unit_test(RefusesOthers),
                                     cmocka_unit_test(RefusesDamage), cmocka_unit_test(RefusesNonsense)};
  if (PetscInitialize(&argc, &argv, NULL, NULL) || ErrorHandlerPush()) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  const int failed = cmocka_run_group_tests(tests, Start, DirectoryRemove);
  return PetscFinalize() || failed;
}
