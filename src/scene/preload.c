/* The environment in which gmsh starts soonest. The loader looks each symbol up in all libraries in turn, which is most of what a small mesh takes; with the
   largest of its libraries first that is a third less. */
#define _GNU_SOURCE /* environ */
#include "sceneimpl.h"
#include <unistd.h>

#define PRELOAD "LD_PRELOAD="

/* "<gmsh>:<its libraries, the largest first>" where the program was built, "": unknown. */
static const char Known[] = GMSH_LIBRARIES;

/* Is it the file that PATH finds under this name? */
static PetscBool Found_Private(const char *name, const char *file, size_t length)
{
  const char *path = getenv("PATH");
  char        here[PETSC_MAX_PATH_LEN], real[PATH_MAX];

  while (path && path[0]) {
    const int n = (int)strcspn(path, ":");
    (void)snprintf(here, sizeof(here), "%.*s/%s", n, path, name);
    if (!access(here, X_OK)) return (PetscBool)(realpath(here, real) && strlen(real) == length && !strncmp(real, file, length));
    path += n + (path[n] == ':');
  }
  return PETSC_FALSE;
}

/* Are all of these files there? Of what is not the loader would complain. */
static PetscBool There_Private(const char *files)
{
  char file[PETSC_MAX_PATH_LEN];

  for (const char *f = files; *f; f += strspn(f, ":")) {
    const size_t n = strcspn(f, ":");
    (void)snprintf(file, sizeof(file), "%.*s", (int)n, f);
    if (access(file, R_OK)) return PETSC_FALSE;
    f += n;
  }
  return PETSC_TRUE;
}

char **PreloadEnvironment(const char *program)
{
  const size_t length = strcspn(Known, ":");
  const char  *given  = getenv("LD_PRELOAD");
  size_t       num = 0, kept = 1;

  if (!length || !Found_Private(program, Known, length) || !There_Private(Known + length + 1)) return environ;
  while (environ[num]) ++num;
  const size_t size = sizeof(PRELOAD) + sizeof(Known) + (given ? strlen(given) : 0);
  char       **all  = malloc((num + 2) * sizeof(*all) + size);
  if (!all) return environ;
  all[0] = (char *)(all + num + 2);
  (void)snprintf(all[0], size, PRELOAD "%s%s", given && given[0] ? given : "", Known + length + !(given && given[0]));
  for (size_t i = 0; i < num; ++i)
    if (strncmp(environ[i], PRELOAD, strlen(PRELOAD))) all[kept++] = environ[i];
  all[kept] = NULL;
  return all;
}
