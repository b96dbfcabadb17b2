/* Private to diagnose. */
#pragma once
#include "diagnose.h"

/* terminal.c: a terminal that shows \r and "erase to the end of the line" to somebody, also behind a launcher of MPI. */
PetscBool DiagnoseIsTerminal(FILE *stream);
