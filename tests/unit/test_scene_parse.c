/* The parser of scenes: damaged text ends in an input error, never in a crash; names with '_' are found; the command line wins. */
#include "sceneimpl.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <unistd.h>

#include <cmocka.h>

static const char Text[] = "title: test\n"
                           "mesh: {file: box.geo, parameter: {n: 4}}\n"
                           "model: plane_strain\n"
                           "body:\n"
                           "  disc:  {material: rubber}\n"
                           "  disc_a: {material: rubber_soft, order: 2}\n"
                           "material:\n"
                           "  rubber: {law: neo_hookean, E: 1, nu: 0.3}\n"
                           "  rubber_soft: {law: neo_hookean, mu: 0.1, kappa: 1}\n"
                           "boundary:\n"
                           "  top:    {displacement: {x: 0, y: \"-0.05*t\"}, amplitude: [0,0, 1,1, 2,pi/2]}\n"
                           "  bottom_left: {fix: xy}\n"
                           "contact:\n"
                           "  a_b: {nonmortar: disc_surface, mortar: block_top, friction: 0}\n"
                           "load: {end: 2, step: 0.1}\n"
                           "probe: {tip: {x: 1, y: -2.5}}\n"
                           "output: {directory: out, segments: yes}\n";

/* Read text with options as SceneCreate does, without files. */
static PetscErrorCode Read(const char *text, size_t length, int argc, char **argv, Scene *scene)
{
  Scene          s;
  PetscErrorCode status;

  PetscCall(PetscNew(&s));
  *scene  = s;
  s->comm = PETSC_COMM_SELF;
  PetscCall(PetscStrncpy(s->data.file, "test.yml", sizeof(s->data.file)));
  status = SceneParse("test.yml", text, length, &s->root);
  if (!status) status = SceneRead(s, argc, argv);
  return status;
}

static void ReadsValues(void **state)
{
  Scene            s;
  const SceneData *d;

  assert_int_equal(Read(Text, strlen(Text), 0, NULL, &s), 0);
  assert_int_equal(SceneGetData(s, &d), 0);
  assert_string_equal(d->title, "test");
  assert_int_equal(d->mechanics.model, MODEL_PLANE_STRAIN);
  assert_int_equal(d->num_materials, 2);
  assert_float_equal(d->materials[0].mu, 1 / 2.6, 1e-15);
  assert_ptr_equal(s->body[1].spec.material, &d->materials[1]);
  assert_int_equal(s->body[0].spec.order, 1);
  assert_int_equal(s->body[1].spec.order, 2);
  assert_true(ExpressionUsesTime(s->boundary[0].spec.displacement[1]));
  assert_null(s->boundary[0].spec.displacement[2]);
  assert_int_equal(s->boundary[0].spec.amplitude.num, 3);
  assert_float_equal(s->boundary[0].spec.amplitude.pairs[5], PETSC_PI / 2, 1e-15);
  assert_true(s->boundary[1].spec.fix[0] && s->boundary[1].spec.fix[1] && !s->boundary[1].spec.fix[2]);
  assert_float_equal(d->load.step_max, 0.1, 0);
  assert_float_equal(d->probes[0].X[1], -2.5, 0);
  assert_true(d->output.fields && d->output.segments);
  assert_int_equal(SceneDestroy(&s), 0);
}

static void CommandLineWins(void **state)
{
  Scene     s;
  char     *argv[] = {"mortise",
                      "x.yml",
                      "-material_rubber_soft_mu",
                      "0.2",
                      "-material_rubber_E",
                      "2",
                      "-boundary_bottom_left_fix",
                      "y",
                      "-body_disc_a_order",
                      "3",
                      "-probe_tip_y",
                      "-3",
                      "-probe_side_2_x",
                      "7",
                      "-boundary_top_amplitude",
                      "[0,1, 5,2]",
                      "-snes_rtol",
                      "1e-3",
                      "-adapt_max_cells",
                      "50"};
  const int argc   = sizeof(argv) / sizeof(argv[0]);

  assert_int_equal(Read(Text, strlen(Text), argc, argv, &s), 0);
  assert_float_equal(s->data.materials[1].mu, 0.2, 0);
  assert_float_equal(s->data.materials[0].mu, 2 / 2.6, 1e-15);
  assert_true(!s->boundary[1].spec.fix[0] && s->boundary[1].spec.fix[1]);
  assert_int_equal(s->body[1].spec.order, 3);
  assert_float_equal(s->data.probes[0].X[1], -3, 0);
  assert_string_equal(s->data.probes[1].name, "side_2");
  assert_int_equal(s->boundary[0].spec.amplitude.num, 2);
  assert_float_equal(s->boundary[0].spec.amplitude.pairs[3], 2, 0);
  assert_int_equal(s->data.adapt.max_cells, 50);
  assert_int_equal(SceneDestroy(&s), 0);
}

static void NamesNearest(void **state)
{
  SceneNode *root;
  char       nearest[256];

  assert_int_equal(SceneParse("test.yml", Text, strlen(Text), &root), 0);
  OptionNearest(root, "material.rubber.lav", '.', sizeof(nearest), nearest);
  assert_string_equal(nearest, "material.rubber.law");
  OptionNearest(root, "tolerance", '.', sizeof(nearest), nearest);
  assert_string_equal(nearest, "adapt.tolerance");
  OptionNearest(root, "boundry", '.', sizeof(nearest), nearest);
  assert_string_equal(nearest, "boundary");
  OptionNearest(root, "contact_ab_friction", '_', sizeof(nearest), nearest);
  assert_string_equal(nearest, "contact_a_b_friction");
  assert_int_equal(NodeDestroy(&root), 0);
}

/* One to eight random edits: flip, drop, double, swap with pieces that mean something to YAML. */
static void Damage(PetscRandom random, char *text, size_t *length, size_t capacity)
{
  static const char *const pieces[] = {"{", "}", "[", "]", ": ", "\n", "  ", "\t",  "&a ",   "*a", "!!x ", "---\n",    "\"", "'",
                                       "#", "%", "|", ">", "\\", "-",  ",",  "nan", "1e999", "~",  "\xff", "\xc3\xa9", "? ", "<<: "};
  PetscReal                r;
  int                      edits;

  PetscRandomGetValueReal(random, &r);
  edits = 1 + (int)(7.9 * r);
  while (edits--) {
    PetscReal a, b, c;
    size_t    at, n;
    PetscRandomGetValueReal(random, &a);
    PetscRandomGetValueReal(random, &b);
    PetscRandomGetValueReal(random, &c);
    at = (size_t)(a * (PetscReal)*length);
    if (b < 0.25)
      text[at] = (char)(c * 255.9);
    else if (b < 0.5) { /* drop up to 20 characters */
      n = PetscMin((size_t)(c * 20), *length - at);
      memmove(text + at, text + at + n, *length - at - n);
      *length -= n;
    } else { /* insert a piece or a copy of what stands elsewhere */
      const char *piece = pieces[(size_t)(c * 0.999 * (PetscReal)(sizeof(pieces) / sizeof(pieces[0])))];
      char        copy[40];
      n = strlen(piece);
      if (b > 0.75) {
        n     = PetscMin((size_t)39, *length);
        piece = memcpy(copy, text + (size_t)(c * (PetscReal)(*length - n)), n);
      }
      if (*length + n > capacity) continue;
      memmove(text + at + n, text + at, *length - at);
      memcpy(text + at, piece, n);
      *length += n;
    }
    if (*length < 2) return;
  }
}

static PetscInt num_damaged = 5000; /* of all ranks together; with -slow 20000 */

static void DamageNeverCrashes(void **state)
{
  PetscMPIInt rank, size;
  PetscRandom random;
  PetscInt    good = 0, bad = 0;
  int         keep = dup(2);

  assert_int_equal(PetscRandomCreate(PETSC_COMM_SELF, &random), 0);
  assert_int_equal(MPI_Comm_rank(PETSC_COMM_WORLD, &rank), 0);
  assert_int_equal(MPI_Comm_size(PETSC_COMM_WORLD, &size), 0);
  const PetscInt num = num_damaged / size;
  PetscRandomSetSeed(random, 12345 + (unsigned long)rank);
  PetscRandomSeed(random);
  assert_non_null(freopen("/dev/null", "w", stderr)); /* thousands of sentences */
  for (PetscInt i = 0; i < num; ++i) {
    char           text[4096];
    size_t         length = strlen(Text);
    Scene          s;
    PetscErrorCode status;
    memcpy(text, Text, length);
    Damage(random, text, &length, sizeof(text));
    status = Read(text, length, 0, NULL, &s);
    SceneDestroy(&s);
    if (status)
      ++bad;
    else
      ++good;
    if (status && status != MORTISE_ERR_INPUT) fail_msg("status %d from:\n%.*s", (int)status, (int)length, text);
  }
  (void)dup2(keep, 2);
  PetscRandomDestroy(&random);
  assert_true(bad > num / 2);
  assert_true(good > num / 200); /* some damage is harmless: the test reaches the readers too */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(ReadsValues), cmocka_unit_test(CommandLineWins), cmocka_unit_test(NamesNearest),
                                     cmocka_unit_test(DamageNeverCrashes)};
  int                     failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ErrorHandlerPush());
  PetscBool slow;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-slow", &slow));
  if (slow) num_damaged = 20000;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
