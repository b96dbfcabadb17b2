/* summary.json without a mesh: a run that solved nothing, figures that are no numbers, names and shapes of the contract; columns of the tables. */
#include "output.h"
#include <cjson/cJSON.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "directory.h"
#include "near.h"

static PetscMPIInt  rank, size;
static SceneData    scene;
static BoundarySpec boundary[2];
static ContactSpec  contact;
static ProbeSpec    probe;

static char *Read(const char *name)
{
  char   path[PETSC_MAX_PATH_LEN], *text;
  FILE  *file;
  size_t length;

  snprintf(path, sizeof(path), "%s/%s", scene.output.directory, name);
  file = fopen(path, "r");
  assert_non_null(file);
  text         = calloc(1, 100000);
  length       = fread(text, 1, 99999, file);
  text[length] = 0;
  fclose(file);
  return text;
}

static cJSON *Document(void)
{
  char  *text = Read("summary.json");
  cJSON *root;

  assert_null(strstr(text, "nan"));
  assert_null(strstr(text, "inf"));
  root = cJSON_Parse(text);
  assert_non_null(root);
  free(text);
  return root;
}

static double Number(const cJSON *object, const char *key)
{
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);

  assert_true(cJSON_IsNumber(item));
  return item->valuedouble;
}

/* Every key of the contract is there, whatever happened. */
static void NothingSolved(void **state)
{
  static const char *const keys[]  = {"mortise",
                                      "scene",
                                      "status",
                                      "reason",
                                      "t",
                                      "model",
                                      "ranks",
                                      "load_steps",
                                      "step_cuts",
                                      "adapt_passes",
                                      "newton_iterations",
                                      "cells",
                                      "dofs",
                                      "order_min",
                                      "order_max",
                                      "estimated_error",
                                      "energy",
                                      "reaction",
                                      "contact",
                                      "probe",
                                      "time",
                                      "peak_memory_mb"};
  static const char *const times[] = {"total", "mesh", "assemble", "contact", "factor", "solve", "estimate", "output"};
  const RunSummary         summary = {.status = "failed", .reason = "no \"luck\"", .seconds = 1.5};

  assert_int_equal(OutputSummary(PETSC_COMM_WORLD, &scene, &summary), 0);
  if (rank) return;
  cJSON *root = Document();
  for (size_t i = 0; i < sizeof(keys) / sizeof(*keys); ++i) assert_true(cJSON_HasObjectItem(root, keys[i]));
  const cJSON *time = cJSON_GetObjectItem(root, "time");
  for (size_t i = 0; i < sizeof(times) / sizeof(*times); ++i) assert_true(Number(time, times[i]) >= 0);
  assert_string_equal(cJSON_GetObjectItem(root, "scene")->valuestring, "a.yml");
  assert_string_equal(cJSON_GetObjectItem(root, "reason")->valuestring, "no \"luck\"");
  assert_string_equal(cJSON_GetObjectItem(root, "model")->valuestring, "plane_strain");
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(root, "cells")));
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(root, "estimated_error")));
  assert_near(Number(time, "total"), 1.5, 0);
  assert_near(Number(root, "ranks"), size, 0);
  const double memory = Number(root, "peak_memory_mb");
  assert_true(memory > 1 && memory < 1e5 && memory >= Number(root, "peak_memory_rank_mb"));
  cJSON_Delete(root);
}

static void Figures(void **state)
{
  PetscReal     reaction[2][3] = {{1, -2, 0}, {7, 7, 7}}, about[2][3] = {{0, 0, 6}, {8, 8, 8}};
  PairFigures   pair    = {.force        = {{0.25, 3}, {-0.25, -3}},
                           .moment       = {{0, 0, 5}, {0, 0, -5}},
                           .max_pressure = NAN,
                           .area         = 0.41,
                           .radius       = 0.206,
                           .min_gap      = -1e-9,
                           .active_nodes = 17};
  const Balance balance = {
      .num_boundaries = 2, .num_contacts = 1, .reaction = reaction, .support_moment = about, .pair = &pair, .status = {.energy = 1. / 3, .min_det = 0.9}};
  const Estimate   estimate = {.total = 2, .norm = INFINITY, .relative = 0.5, .part = {4, 0, 0, 0, 0}};
  const Path       path     = {.newton_iterations = 12};
  const RunSummary summary  = {.status = "converged", .reason = "", .t = 1, .load_steps = 3, .path = &path, .balance = &balance, .estimate = &estimate};

  assert_int_equal(OutputSummary(PETSC_COMM_WORLD, &scene, &summary), 0);
  if (rank) return;
  cJSON       *root      = Document();
  const cJSON *reactions = cJSON_GetObjectItem(root, "reaction"), *top = cJSON_GetObjectItem(reactions, "top"),
              *zone = cJSON_GetObjectItem(cJSON_GetObjectItem(root, "contact"), "pair");
  assert_int_equal(cJSON_GetArraySize(reactions), 1); /* the other boundary only carries a pressure */
  assert_int_equal(cJSON_GetArraySize(top), 2);
  assert_near(cJSON_GetArrayItem(top, 1)->valuedouble, -2, 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(root, "reaction_moment")), 1);
  assert_near(cJSON_GetArrayItem(cJSON_GetObjectItem(cJSON_GetObjectItem(root, "reaction_moment"), "top"), 0)->valuedouble, 6, 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(zone, "force")), 2);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(zone, "moment")), 1);
  assert_near(cJSON_GetArrayItem(cJSON_GetObjectItem(zone, "moment"), 0)->valuedouble, 5, 0);
  assert_near(cJSON_GetArrayItem(cJSON_GetObjectItem(zone, "mortar_force"), 1)->valuedouble, -3, 0);
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(zone, "max_pressure")));
  assert_near(Number(zone, "radius"), 0.206, 0);
  assert_near(Number(zone, "area"), 0.41, 0);
  assert_near(Number(zone, "active_nodes"), 17, 0);
  assert_near(Number(zone, "min_gap"), -1e-9, 0);
  assert_near(Number(root, "energy"), 1. / 3, 0);
  assert_near(Number(root, "estimated_error"), 0.5, 0);
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(cJSON_GetObjectItem(root, "estimate"), "norm")));
  assert_near(Number(cJSON_GetObjectItem(root, "estimate"), "interior"), 2, 0);
  cJSON_Delete(root);
}

static PetscInt Fields(const char *line)
{
  PetscInt n = 1;
  for (; *line && *line != '\n'; ++line) n += *line == ',';
  return n;
}

/* As many values as names, and each under its own. */
static void Tables(void **state)
{
  PetscReal       reaction[2][3] = {{1, -2, 0}, {7, 7, 7}}, about[2][3] = {{0, 0, 6}, {8, 8, 8}};
  PairFigures     pair    = {.force = {{0.25, 3}}, .moment = {{0, 0, 5}}, .radius = 0.206, .active_nodes = 17};
  const Balance   balance = {.num_boundaries = 2, .num_contacts = 1, .reaction = reaction, .support_moment = about, .pair = &pair};
  const ReportRow row     = {.step                = 4,
                             .t                   = 0.5,
                             .cells               = 99,
                             .estimated_error     = NAN,
                             .seconds             = 2.5,
                             .viscous_work        = 0.125,
                             .frozen_segmentation = PETSC_TRUE,
                             .modifiers           = 3,
                             .accepted            = PETSC_TRUE};
  History         history;

  assert_int_equal(HistoryCreate(PETSC_COMM_WORLD, &scene, NULL, NULL, &history), 0);
  assert_int_equal(HistoryPass(history, &row), 0);
  assert_int_equal(HistoryStep(history, &row, &balance, NULL, NULL), 0);
  assert_int_equal(HistoryDestroy(&history), 0);
  if (rank) return;
  char *text = Read("history.csv"), *values = strchr(text, '\n') + 1;
  assert_int_equal(Fields(text), Fields(values));
  assert_non_null(strstr(
      text, ",seconds,viscous_work,frozen_segmentation,modifiers,reaction.top.x,reaction.top.y,reaction.top.moment,contact.pair.force.x,contact.pair.force.y,"
            "contact.pair.moment,contact.pair.max_pressure,"
            "contact.pair.area,contact.pair.radius,contact.pair.active_nodes,contact.pair.min_gap\n"));
  assert_non_null(strstr(values, ",2.5,0.125,1,3,1,-2,6,0.25,3,5,0,0,0.206,17,0\n"));
  free(text);
  text   = Read("adapt.csv");
  values = strchr(text, '\n') + 1;
  assert_int_equal(Fields(text), Fields(values));
  assert_true(!strncmp(text, "step,pass,t,cells,dofs,", 23) && !strncmp(values, "4,0,0.5,99,0,", 13));
  free(text);
}

/* Parents are made; a file in the way is told. */
static void Directories(void **state)
{
  char        path[PETSC_MAX_PATH_LEN];
  struct stat kind;

  snprintf(path, sizeof(path), "%s/deep/er/", directory);
  assert_int_equal(OutputDirectoryCreate(PETSC_COMM_WORLD, path), 0);
  assert_int_equal(OutputDirectoryCreate(PETSC_COMM_WORLD, path), 0);
  assert_true(stat(path, &kind) == 0 && S_ISDIR(kind.st_mode));
  assert_int_equal(PetscPushErrorHandler(PetscReturnErrorHandler, NULL), 0);
  assert_int_equal(OutputDirectoryCreate(PETSC_COMM_WORLD, "/dev/null/x"), MORTISE_ERR_INPUT);
  assert_int_equal(OutputDirectoryCreate(PETSC_COMM_WORLD, "/dev/null"), MORTISE_ERR_INPUT);
  assert_int_equal(PetscPopErrorHandler(), 0);
}

static int Begin(void **state)
{
  if (DirectoryCreate(state)) return 1;
  strcpy(scene.output.directory, directory);
  strcpy(scene.file, "some/where/a.yml");
  strcpy(boundary[0].name, "top");
  strcpy(boundary[1].name, "inner");
  strcpy(contact.name, "pair");
  strcpy(probe.name, "tip");
  boundary[0].fix[1]             = PETSC_TRUE;
  scene.mechanics.num_boundaries = 2;
  scene.mechanics.boundaries     = boundary;
  scene.num_contacts             = 1;
  scene.contacts                 = &contact;
  scene.num_probes               = 1;
  scene.probes                   = &probe;
  return 0;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(NothingSolved), cmocka_unit_test(Figures), cmocka_unit_test(Tables), cmocka_unit_test(Directories)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  failed = cmocka_run_group_tests(tests, Begin, DirectoryRemove);
  if (PetscFinalize()) return 1;
  return failed;
}
