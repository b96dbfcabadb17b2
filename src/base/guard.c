/* Libraries trust the numbers in a file. While one reads a file whose numbers may be anything, a signal there becomes the sentence and exit status 1 of wrong
   input. Nothing can be cleaned up any more: the heap may be broken. */
#include "base.h"
#include <signal.h>
#include <unistd.h>

static const int Signals[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL};

enum { NUM_SIGNALS = sizeof(Signals) / sizeof(Signals[0]) };

static char             sentence[PETSC_MAX_PATH_LEN + 128];
static struct sigaction before[NUM_SIGNALS];

static void Tell_Private(int number)
{
  if (write(STDERR_FILENO, sentence, strlen(sentence)) < 0) _exit(2);
  _exit(1);
}

void GuardBegin(const char *format, ...)
{
  struct sigaction guard = {.sa_handler = Tell_Private};
  size_t           used  = (size_t)snprintf(sentence, sizeof(sentence), "mortise: ");
  va_list          arguments;

  va_start(arguments, format);
  (void)vsnprintf(sentence + used, sizeof(sentence) - used - 1, format, arguments);
  va_end(arguments);
  TextAppend(sizeof(sentence), sentence, "\n");
  for (int i = 0; i < NUM_SIGNALS; ++i) sigaction(Signals[i], &guard, &before[i]);
}

void GuardEnd(void)
{
  for (int i = 0; i < NUM_SIGNALS; ++i) sigaction(Signals[i], &before[i], NULL);
}
