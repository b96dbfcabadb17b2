/* Expressions and amplitudes: values against their closed forms, bad texts refused. */
#include "base.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static PetscReal Value(const char *text, PetscReal x, PetscReal y, PetscReal z, PetscReal t)
{
  Expression      e;
  const PetscReal X[3] = {x, y, z};
  PetscReal       value;

  assert_int_equal(ExpressionCreate("key", text, &e), 0);
  assert_int_equal(ExpressionEvaluate(e, X, t, &value), 0);
  assert_int_equal(ExpressionDestroy(&e), 0);
  return value;
}

static void Values(void **state)
{
  assert_float_equal(Value("-0.05", 1, 2, 3, 4), -0.05, 0);
  assert_float_equal(Value("1e-3", 1, 2, 3, 4), 1e-3, 0);
  assert_float_equal(Value("2*pi", 0, 0, 0, 0), 2 * PETSC_PI, 1e-15);
  assert_float_equal(Value("0.1*Y*sin(pi*t)", 0, 3, 0, 0.25), 0.3 * PetscSinReal(PETSC_PI / 4), 1e-15);
  assert_float_equal(Value("X^2-Z/4", 3, 0, 2, 0), 8.5, 1e-15);
  assert_float_equal(Value("0.5*max(t-1, 0)", 0, 0, 0, 1.5), 0.25, 1e-15);
  assert_float_equal(Value("t <= 1 ? t : 1", 0, 0, 0, 7), 1, 0);
}

static void KnowsTime(void **state)
{
  Expression e;

  assert_int_equal(ExpressionCreate("key", "X*t", &e), 0);
  assert_true(ExpressionUsesTime(e));
  assert_string_equal(ExpressionText(e), "X*t");
  ExpressionDestroy(&e);
  assert_int_equal(ExpressionCreate("key", "tan(X)", &e), 0);
  assert_false(ExpressionUsesTime(e));
  ExpressionDestroy(&e);
}

static void RefusesNonsense(void **state)
{
  const char *bad[] = {"", " ", "x", "2*", "sin(", "1,2", "nan", "inf", "1/0", "X=3", "abc", "0.1*Y)", "\"text\"", "1 2", "$", "+"};

  for (size_t i = 0; i < sizeof(bad) / sizeof(bad[0]); ++i) {
    Expression e;
    if (ExpressionCreate("key", bad[i], &e) != MORTISE_ERR_INPUT) fail_msg("accepted: %s", bad[i]);
    ExpressionDestroy(&e);
  }
}

/* Body forces of made-up solutions are long; beyond the limit stands a message, not a cut text. */
static void Long(void **state)
{
  char       text[8192] = "X";
  Expression e;

  while (strlen(text) < 3990) strcat(text, "+Y");
  assert_float_equal(Value(text, 1, 2, 0, 0), 1 + 2 * (double)((strlen(text) - 1) / 2), 0);
  while (strlen(text) <= 4000) strcat(text, "+Y");
  assert_int_equal(ExpressionCreate("key", text, &e), MORTISE_ERR_INPUT);
  ExpressionDestroy(&e);
}

static void Amplitudes(void **state)
{
  PetscReal       pairs[] = {0, 0, 1, 2, 3, 2, 4, -1};
  const Amplitude a = {.num = 4, .pairs = pairs}, ramp = {.num = 0}, endless = {.endless = PETSC_TRUE}, on = {.num = 4, .pairs = pairs, .endless = PETSC_TRUE};

  assert_float_equal(AmplitudeEvaluate(&ramp, 0.3), 0.3, 1e-15);
  assert_float_equal(AmplitudeEvaluate(&ramp, 5), 1, 0);
  assert_float_equal(AmplitudeEvaluate(&endless, 5), 5, 0);
  assert_float_equal(AmplitudeEvaluate(&endless, -2), -2, 0);
  assert_float_equal(AmplitudeEvaluate(&a, -1), 0, 0);
  assert_float_equal(AmplitudeEvaluate(&a, 0.5), 1, 1e-15);
  assert_float_equal(AmplitudeEvaluate(&a, 2), 2, 1e-15);
  assert_float_equal(AmplitudeEvaluate(&a, 3.5), 0.5, 1e-15);
  assert_float_equal(AmplitudeEvaluate(&a, 9), -1, 0);
  assert_float_equal(AmplitudeEvaluate(&on, 9), pairs[7] + (9 - pairs[6]) * (pairs[7] - pairs[5]) / (pairs[6] - pairs[4]), 1e-14);
  assert_float_equal(AmplitudeEvaluate(&on, 0.5), 1, 1e-15);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Values), cmocka_unit_test(KnowsTime), cmocka_unit_test(RefusesNonsense), cmocka_unit_test(Long),
                                     cmocka_unit_test(Amplitudes)};
  int                     failed;

  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  PetscCall(ErrorHandlerPush());
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  PetscCall(PetscFinalize());
  return failed;
}
