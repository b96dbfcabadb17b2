/* -help json: keys, laws, columns, fields and exit statuses in one JSON object, for what is made from them (scripts/describe). */
#include "appimpl.h"
#include <cjson/cJSON.h>
#include <stdlib.h>

const ExitStatus ExitStatuses[] = {
    {0, "converged to the end"},
    {1, "bad input, nothing was solved: one sentence says which key, which value, what is allowed"},
    {2, "the solver gave up: status failed; or inaccurate, where all load steps were solved, but adapt.tolerance was not reached in all of them"},
    {3, "stopped, by SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU, SIGPIPE or -max_seconds, with a checkpoint for -restart; before there is a "
        "mesh, with nothing"},
    {0, NULL},
};

static void DescribeFields_Private(cJSON *root, const char *file, const OutputField *field)
{
  cJSON *array = cJSON_AddArrayToObject(root, file);

  for (; field->name; ++field) {
    cJSON *row = cJSON_CreateObject();
    cJSON_AddStringToObject(row, "name", field->name);
    cJSON_AddStringToObject(row, "unit", field->unit);
    cJSON_AddStringToObject(row, "help", field->help);
    cJSON_AddItemToArray(array, row);
  }
}

static void DescribeExit_Private(cJSON *root)
{
  cJSON *array = cJSON_AddArrayToObject(root, "exit");

  for (const ExitStatus *e = ExitStatuses; e->text; ++e) {
    cJSON *row = cJSON_CreateObject();
    cJSON_AddNumberToObject(row, "status", e->status);
    cJSON_AddStringToObject(row, "help", e->text);
    cJSON_AddItemToArray(array, row);
  }
}

PetscErrorCode AppDescribe(MPI_Comm comm)
{
  PetscMPIInt rank;
  cJSON      *root, *files;
  char       *text;

  PetscFunctionBegin;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "mortise", MORTISE_VERSION);
  PetscCall(SceneDescribe(root));
  files = cJSON_AddObjectToObject(root, "files");
  DescribeFields_Private(files, "history.csv", OutputHistoryColumns);
  DescribeFields_Private(files, "adapt.csv", OutputAdaptColumns);
  DescribeFields_Private(files, "summary.json", OutputSummaryFields);
  DescribeFields_Private(files, "fields.xdmf", OutputFieldFields);
  DescribeExit_Private(root);
  text = cJSON_Print(root);
  cJSON_Delete(root);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_MEM, "no room for the tables");
  (void)puts(text);
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
