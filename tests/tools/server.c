/* Starts of one program without what each of them repeats: loading and linking its hundred libraries. Preloaded, it stops the program before main, and for each
   request on descriptor 198 lets a copy of it (fork) go on into main. The copy is the program with nothing of it left out, in a session of its own.
   Request: four numbers (bytes that follow, limit of memory in bytes or 0, number of words, number of variables), then words, each ended by 0: working
   directory, files for stdout and stderr, arguments; then the environment. Answers on descriptor 199: the number of the process; at its end its status, and the
   most memory that it had in kB. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { REQUESTS = 198, ANSWERS };

typedef int (*Main)(int, char **, char **);
static Main program;

static void Read(void *to, size_t num)
{
  for (char *at = to; num > 0;) {
    const ssize_t got = read(REQUESTS, at, num);
    if (got <= 0) _exit(0);
    at += got, num -= (size_t)got;
  }
}

static void Answer(const long *numbers, size_t num)
{
  if (write(ANSWERS, numbers, num * sizeof(*numbers)) < 0) _exit(1);
}

/* Take a descriptor's place by a file. */
static void Redirect(const char *file, int flags, int place)
{
  const int fd = open(file, flags, 0600);
  if (fd < 0 || dup2(fd, place) < 0) _exit(126);
  close(fd);
}

static int Child(char *text, long limit, int num, int variables, char *name)
{
  char **argv = calloc((size_t)num, sizeof(char *)), **environment = calloc((size_t)variables + 1, sizeof(char *)), *word[3];
  int    argc = 1;

  argv[0] = name;
  for (int i = 0; i < num; ++i, text += strlen(text) + 1) {
    if (i < 3)
      word[i] = text;
    else
      argv[argc++] = text;
  }
  for (int i = 0; i < variables; ++i, text += strlen(text) + 1) environment[i] = text;
  environ = environment;
  close(REQUESTS);
  close(ANSWERS);
  setsid();
  if (limit) {
    struct rlimit memory;
    getrlimit(RLIMIT_DATA, &memory);
    memory.rlim_cur = (rlim_t)limit;
    setrlimit(RLIMIT_DATA, &memory);
  }
  if (chdir(word[0])) _exit(126);
  Redirect("/dev/null", O_RDONLY, 0);
  Redirect(word[1], O_WRONLY | O_CREAT | O_TRUNC, 1);
  Redirect(word[2], O_WRONLY | O_CREAT | O_TRUNC, 2);
  return program(argc, argv, environment);
}

static int Serve(int argc, char **argv, char **environment)
{
  for (;;) {
    long          request[4], answer[2];
    int           status;
    struct rusage usage;
    Read(request, sizeof(request));
    char *text = malloc((size_t)request[0]);
    Read(text, (size_t)request[0]);
    const pid_t pid = fork();
    if (pid == 0) return Child(text, request[1], (int)request[2], (int)request[3], argv[0]);
    answer[0] = pid;
    Answer(answer, 1);
    if (pid < 0) _exit(1);
    wait4(pid, &status, 0, &usage);
    answer[0] = status;
    answer[1] = usage.ru_maxrss;
    Answer(answer, 2);
    free(text);
  }
}

int __libc_start_main(Main entry, int argc, char **argv, void (*init)(void), void (*fini)(void), void (*rtld_fini)(void), void *stack_end)
{
  int (*next)(Main, int, char **, void (*)(void), void (*)(void), void (*)(void), void *);

  *(void **)&next = dlsym(RTLD_NEXT, "__libc_start_main");
  program         = entry;
  return next(Serve, argc, argv, init, fini, rtld_fini, stack_end);
}
