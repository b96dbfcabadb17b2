# mortise: adaptive mortar contact. `make demo` and `make test` do everything on a fresh Debian 12 machine.
#   make [DEBUG=1] [PORTABLE=1] [PETSC_DIR=… PETSC_ARCH=…]

MODULES ?= base element material forest hp mechanics contact scene problem solve estimate transfer output diagnose app
BUILD   ?= build$(if $(DEBUG),-debug)
CC      := mpicc
TRIPLET := $(shell gcc -dumpmachine 2>/dev/null)

# PETSc: PETSC_DIR/PETSC_ARCH when given, else pkg-config, else Debian's prefix layout.
ifdef PETSC_DIR
  PETSC_CFLAGS := -I$(PETSC_DIR)/include $(if $(PETSC_ARCH),-I$(PETSC_DIR)/$(PETSC_ARCH)/include)
  PETSC_LIBDIR := $(PETSC_DIR)/$(if $(PETSC_ARCH),$(PETSC_ARCH)/)lib
  PETSC_LIBS   := -L$(PETSC_LIBDIR) -Wl,-rpath,$(PETSC_LIBDIR) $(if $(wildcard $(PETSC_LIBDIR)/libpetsc_real.so),-lpetsc_real,-lpetsc)
else ifeq ($(shell pkg-config --exists PETSc 2>/dev/null && echo yes),yes)
  PETSC_CFLAGS := $(shell pkg-config --cflags PETSc)
  PETSC_LIBS   := $(shell pkg-config --libs PETSc)
else
  PETSC_PREFIX := $(lastword $(sort $(wildcard /usr/lib/petscdir/petsc*/$(TRIPLET)-real)))
  PETSC_CFLAGS := -I$(PETSC_PREFIX)/include
  PETSC_LIBS   := -L$(PETSC_PREFIX)/lib -lpetsc_real
endif
HDF5_CFLAGS := $(shell pkg-config --cflags hdf5-openmpi 2>/dev/null)
HDF5_LIBS   := $(or $(shell pkg-config --libs hdf5-openmpi 2>/dev/null),-lhdf5)

ifdef DEBUG
  OPT := -O1 -g -fsanitize=address,undefined -fno-omit-frame-pointer
else
  OPT := -O3 -g $(if $(PORTABLE),,-march=native)
endif
CFLAGS   := -std=gnu11 $(OPT) -Wall -Wextra -Wshadow -Wstrict-prototypes -Wno-unused-parameter -Werror -fno-math-errno -MMD -MP
CPPFLAGS := -Iinclude $(addprefix -Isrc/,$(MODULES)) $(PETSC_CFLAGS) $(HDF5_CFLAGS)
LDLIBS   := $(PETSC_LIBS) -lmetis -ldmumps -lsmumps -lmumps_common $(HDF5_LIBS) -lmuparser -lcjson -lyaml -lopenblas -lm

SOURCES := $(foreach m,$(MODULES),$(wildcard src/$(m)/*.c))
OBJECTS := $(SOURCES:src/%.c=$(BUILD)/%.o)
LIBRARY := $(BUILD)/libmortise.a
LIBOBJS := $(filter-out $(BUILD)/app/main.o,$(OBJECTS))
UNITS   := $(patsubst tests/unit/%.c,$(BUILD)/unit/%,$(wildcard tests/unit/test_*.c))

.PHONY: all unit
all: bin/mortise

bin/mortise: $(BUILD)/app/main.o $(LIBRARY)
	@mkdir -p bin
	$(CC) $(CFLAGS) -o $@ $^ $(LDLIBS)

$(LIBRARY): $(LIBOBJS)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/%.o: src/%.c Makefile
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(CPPFLAGS) -c -o $@ $<

$(BUILD)/unit/%: tests/unit/%.c $(LIBRARY)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(CPPFLAGS) -o $@ $< $(LIBRARY) -lcmocka $(LDLIBS)

unit: $(UNITS)
	@for t in $(UNITS); do echo "== $$t"; $$t || exit 1; done

-include $(OBJECTS:.o=.d) $(UNITS:=.d)
