/* The option table and the tables of laws as JSON: completion of shells, the schema for editors and the manual's reference are made from it. */
#include "sceneimpl.h"
#include <cjson/cJSON.h>

static void DescribeKey_Private(cJSON *keys, const Option *row)
{
  static const char *const kinds[] = {"text", "word", "integer", "number", "boolean", "expression", "amplitude", "axes", "parameter", "words", "groups"};
  cJSON                   *key     = cJSON_CreateObject();

  cJSON_AddStringToObject(key, "key", row->pattern);
  cJSON_AddStringToObject(key, "type", kinds[row->type]);
  cJSON_AddStringToObject(key, "unit", row->unit);
  cJSON_AddBoolToObject(key, "required", !row->fallback);
  cJSON_AddStringToObject(key, "default", row->fallback ? row->fallback : "");
  cJSON_AddStringToObject(key, "range", row->range);
  if (row->type == KEY_TEXT) cJSON_AddNumberToObject(key, "longest", (double)row->size - 1);
  cJSON_AddStringToObject(key, "help", row->help);
  cJSON_AddItemToArray(keys, key);
}

static void DescribeLaw_Private(cJSON *laws, const MaterialLaw *row)
{
  cJSON *law = cJSON_CreateObject(), *parameters;

  cJSON_AddStringToObject(law, "law", row->name);
  cJSON_AddStringToObject(law, "help", row->help);
  parameters = cJSON_AddArrayToObject(law, "parameters");
  for (const MaterialParameter *p = row->parameters; p && p->name; ++p) {
    cJSON *parameter = cJSON_CreateObject();
    cJSON_AddStringToObject(parameter, "name", p->name);
    cJSON_AddStringToObject(parameter, "unit", p->unit ? p->unit : "");
    if (p->min > -1e30) cJSON_AddNumberToObject(parameter, "above", (double)p->min);
    if (p->max < 1e30) cJSON_AddNumberToObject(parameter, "below", (double)p->max);
    cJSON_AddBoolToObject(parameter, "limit", MaterialIsLimit(p, p->max)); /* the upper bound itself is allowed */
    cJSON_AddStringToObject(parameter, "help", p->help);
    cJSON_AddItemToArray(parameters, parameter);
  }
  cJSON_AddItemToArray(laws, law);
}

PetscErrorCode SceneDescribe(cJSON *root)
{
  cJSON *keys, *laws;

  PetscFunctionBegin;
  keys = cJSON_AddArrayToObject(root, "keys");
  for (const Option *row = Options; row->pattern; ++row) DescribeKey_Private(keys, row);
  laws = cJSON_AddArrayToObject(root, "laws");
  for (const MaterialLaw *law = MaterialLaws; law->name; ++law) DescribeLaw_Private(laws, law);
  PetscFunctionReturn(PETSC_SUCCESS);
}
