# mortise: contact between bodies that deform a lot. `make demo` and `make test` do everything on a Debian 12 machine
# that has git and make: they install what is missing, build, and run.
#   make [DEBUG=1] [PORTABLE=1] [PETSC_DIR=… PETSC_ARCH=…] [BUILD=…]
#   make install [PREFIX=/usr/local] [DESTDIR=]
#   DEBUG=1     address and undefined sanitizers          PORTABLE=1  no -march=native (for a cluster's head node)
# Every combination has its own build directory and program, so changing a flag never mixes objects.

MODULES ?= base element material forest hp mechanics contact interface scene problem solve path estimate transfer output diagnose needs app
VARIANT := $(if $(DEBUG),-debug)$(if $(PORTABLE),-portable)$(if $(PETSC_DIR),-$(notdir $(PETSC_DIR))$(if $(PETSC_ARCH),-$(PETSC_ARCH)))
BUILD   ?= build$(VARIANT)
PROGRAM ?= bin/mortise$(VARIANT)
CC      := mpicc
Q       := $(if $(V),,@)# V=1 shows the commands
TRIPLET := $(shell gcc -dumpmachine 2>/dev/null)

# Runs as root in a container, more ranks than cores, several runs side by side, of which those that wait give way: all fine for small tests.
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1
export OMPI_MCA_hwloc_base_binding_policy := none
export OMPI_MCA_mpi_yield_when_idle := 1
export OMPI_MCA_pml := ob1
export OMPI_MCA_btl := self,vader
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export ASAN_OPTIONS := detect_leaks=0

# The first python that has what scripts and tests need: the one in PATH, else Debian's. Looked for only where used.
PYTHON = $(shell for p in python3 /usr/bin/python3; do \
  $$p -c 'import importlib.util as u, sys; sys.exit(not all(map(u.find_spec, ("pytest", "h5py", "matplotlib", "numpy"))))' 2>/dev/null && echo $$p && break; done)

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
# The loader looks symbols up in the order of the libraries, and Debian's PETSc brings a hundred: those with the most symbols first take
# 12 of 41 ms off every start.
ifndef PETSC_DIR
  LOAD_FIRST := $(wildcard $(foreach l,teuchosparameterlist ml ifpack epetra epetraext teuchoscomm,/usr/lib/$(TRIPLET)/libtrilinos_$(l).so.[0-9]*.[0-9]*))
endif
# MUMPS in single precision (src/solve/singlefactor.c), where it stands beside the one PETSc was built with.
MUMPS_DIR := $(dir $(firstword $(wildcard $(PETSC_LIBDIR)/libdmumps.*) $(shell $(CC) -print-file-name=libdmumps.so)))
SMUMPS    := $(if $(wildcard $(MUMPS_DIR)libsmumps.*),-lsmumps)
HDF5_CFLAGS := $(shell pkg-config --cflags hdf5-openmpi 2>/dev/null)
HDF5_LIBS   := $(or $(shell pkg-config --libs hdf5-openmpi 2>/dev/null),-lhdf5)

ifdef DEBUG
  OPT := -O1 -g -fsanitize=address,undefined -fno-omit-frame-pointer
else
  OPT := -O3 -g $(if $(PORTABLE),,-march=native)
endif
CFLAGS   := -std=gnu11 $(OPT) -Wall -Wextra -Wshadow -Wstrict-prototypes -Wno-unused-parameter -Wno-maybe-uninitialized -Wno-psabi -Wno-format-truncation -Werror -fno-math-errno -MMD -MP
# Unit programs call the library, which keeps its optimisation: their own code runs once, and takes half as long to compile.
UNIT_CFLAGS = $(patsubst -O3,-O1,$(CFLAGS))
FOLDERS  := $(foreach m,$(MODULES),src/$(m) $(patsubst %/,%,$(wildcard src/$(m)/*/)))
CPPFLAGS := -Iinclude -I$(BUILD) $(addprefix -I,$(FOLDERS)) $(PETSC_CFLAGS) $(HDF5_CFLAGS) $(if $(SMUMPS),-DMORTISE_SMUMPS)
LDLIBS   := -Wl,--no-as-needed -lopenblas $(LOAD_FIRST) -Wl,--as-needed $(PETSC_LIBS) -lmetis -ldmumps $(SMUMPS) -lmumps_common $(HDF5_LIBS) -lmuparser -lcjson -lyaml -lm

SOURCES := $(foreach f,$(FOLDERS),$(wildcard $(f)/*.c))
OBJECTS := $(SOURCES:src/%.c=$(BUILD)/%.o)
LIBRARY := $(BUILD)/libmortise.a
LIBOBJS := $(filter-out $(BUILD)/app/main.o,$(OBJECTS))
UNITS   := $(patsubst tests/unit/%.c,$(BUILD)/unit/%,$(wildcard tests/unit/test_*.c))
BENCHES := $(patsubst tests/bench/%.c,$(BUILD)/bench/%,$(wildcard tests/bench/*.c))
TRACKED  = $(wildcard $(shell git ls-files '*.c' '*.h'))

.PHONY: all install docs units unit bootstrap demo run-demo test run-test verify run-verify gauntlet run-gauntlet chart bench run-bench stability run-stability benchmarks run-benchmarks needs run-needs peers format format-check lint floors sizes clean FORCE
all: $(PROGRAM)

$(BUILD)/mortise: $(BUILD)/app/main.o $(LIBRARY)
	@echo "  LINK $@"
	$(Q)$(CC) $(CFLAGS) -o $@ $^ $(LDLIBS)

# bin/ follows whichever build directory was made last.
$(PROGRAM): $(BUILD)/mortise FORCE
	@mkdir -p $(@D)
	@cmp -s $< $@ || { cp $< $@.new && mv $@.new $@; } # jobs that run keep theirs

$(LIBRARY): $(LIBOBJS)
	@rm -f $@
	$(Q)ar rcs $@ $^

$(BUILD)/%.o: src/%.c Makefile
	@mkdir -p $(@D)
	@echo "  CC   $<"
	$(Q)$(CC) $(CFLAGS) $(CPPFLAGS) -c -o $@ $<

# Files that the program carries with it (mortise new), as strings.
$(BUILD)/app/new.o: $(BUILD)/app/new.yml.inc $(BUILD)/app/new.geo.inc
$(BUILD)/app/new.%.inc: src/app/new.%
	@mkdir -p $(@D)
	$(Q)sed 's/[\\"]/\\&/g; s/^/"/; s/$$/\\n"/' $< > $@

# Gold, where it is there, links the hundred unit programs in half of the time of ld.
GOLD = $(eval GOLD := $(shell echo 'int main(void) { return 0; }' | $(CC) -fuse-ld=gold -x c -o /dev/null - 2>/dev/null && echo -fuse-ld=gold))$(GOLD)

# cmocka.h wants these two before it, whatever order clang-format gives the includes.
$(BUILD)/unit/%: tests/unit/%.c $(LIBRARY)
	@mkdir -p $(@D)
	@echo "  CC   $<"
	$(Q)$(CC) $(UNIT_CFLAGS) $(CPPFLAGS) -include stdarg.h -include setjmp.h -o $@ $< $(LIBRARY) $(GOLD) -lcmocka $(LDLIBS)

$(BUILD)/bench/%: tests/bench/%.c $(LIBRARY)
	@mkdir -p $(@D)
	@echo "  CC   $<"
	$(Q)$(CC) $(CFLAGS) $(CPPFLAGS) -o $@ $< $(LIBRARY) $(LDLIBS)

units: $(UNITS)
unit: $(UNITS)
	@mkdir -p $(BUILD)/unit/run
	@cd $(BUILD)/unit/run && for t in $(abspath $(UNITS)); do echo "== $$t"; $$t || exit 1; done

# ---- what a newcomer types: `bootstrap` first, then a second make that finds the compiler ------------------------------

bootstrap:
	@scripts/bootstrap

demo: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@$(MAKE) --no-print-directory run-demo
run-demo:
	$(PROGRAM) inputs/hertz2d.yml -output_directory out/hertz2d
	$(PYTHON) scripts/plot out/hertz2d

# One runner for unit programs (on 1, 2 and where it matters 3 ranks) and cases: its last line is the count.
PYTEST = MORTISE=$(abspath $(PROGRAM)) MORTISE_BUILD=$(abspath $(BUILD)) $(PYTHON) -B -m pytest -c tests/pytest.ini --rootdir tests -q --durations=5
# Two files of tests at a time, where pytest-xdist is there. The files of tests/verify come last, of which the last ones are short: both ends are near each other.
PARALLEL = $(shell $(PYTHON) -c 'import xdist' 2>/dev/null && echo --numprocesses=2 --dist=loadfile)
test: bootstrap
	@$(MAKE) --no-print-directory -j2 all units
	@$(MAKE) --no-print-directory run-test
run-test:
	@$(PYTEST) $(PARALLEL) -m "not slow" tests/unit tests/stability tests/benchmarks tests/verify

verify: bootstrap
	@$(MAKE) --no-print-directory -j2 all units
	@$(MAKE) --no-print-directory run-verify
run-verify:
	@$(PYTEST) tests/unit tests/verify tests/stability tests/benchmarks

# Where methods fail, run beside them: docs/stability.md. STABILITY="-k clip" runs a part and writes nothing.
stability: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@$(MAKE) --no-print-directory run-stability
run-stability:
	@MORTISE=$(abspath $(PROGRAM)) MORTISE_BUILD=$(abspath $(BUILD)) $(PYTHON) -B tests/stability/run.py $(STABILITY)

# Public problems with published numbers: docs/benchmarks.md.
benchmarks: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@$(MAKE) --no-print-directory run-benchmarks
run-benchmarks:
	@MORTISE=$(abspath $(PROGRAM)) MORTISE_BUILD=$(abspath $(BUILD)) $(PYTHON) -B tests/benchmarks/run.py $(BENCHMARKS)

# Contact scenes without any setting, in every variant (docs/gauntlet.md): a table on the screen and in out/gauntlet.csv. GAUNTLET="--only slide --jobs 2"
gauntlet: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@$(MAKE) --no-print-directory run-gauntlet
run-gauntlet:
	@$(PYTHON) -B tests/gauntlet/run.py --program $(PROGRAM) --csv out/gauntlet.csv $(GAUNTLET)

# What summary.json says a scene does not need, each with and without it: docs/needs.md. NEEDS="plate wheel" runs some and writes nothing.
needs: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@$(MAKE) --no-print-directory run-needs
run-needs:
	@MORTISE=$(abspath $(PROGRAM)) $(PYTHON) -B tests/needs/run.py $(if $(NEEDS),$(NEEDS),--write)

# Other open codes beside this one: docs/peers.md, the table of README.md, docs/charts/peers*. PEERS=folder to install them in; PEERS_RUN="--only hertz2d"
peers: bootstrap
	@$(MAKE) --no-print-directory -j2 all
	@scripts/peers/install
	@MORTISE=$(abspath $(PROGRAM)) $(PYTHON) -B scripts/peers/run.py $(PEERS_RUN)

chart: bootstrap
	@$(MAKE) --no-print-directory -j2 all $(BUILD)/bench/contact
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_hp
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_faces
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_layers
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_angioplasty
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_bulk
	@MORTISE=$(abspath $(PROGRAM)) scripts/chart_friction
	@scripts/chart_search $(BUILD)/bench/contact

bench: bootstrap
	@$(MAKE) --no-print-directory -j2 all run-bench
run-bench: $(BENCHES)
	@for b in $(BENCHES); do echo "== $$b"; $$b || exit 1; done
	@MORTISE=$(abspath $(PROGRAM)) scripts/bench
	@MORTISE=$(abspath $(PROGRAM)) scripts/bench_condense --block

# ---- installation: program, scripts, example scenes, and what scripts/describe makes of the program's own tables ---------------

PREFIX ?= /usr/local
BINDIR   = $(DESTDIR)$(PREFIX)/bin
SHAREDIR = $(DESTDIR)$(PREFIX)/share
ZSHDIR   = $(PREFIX)/share/zsh/site-functions
DESCRIBE = MORTISE=$(abspath $(PROGRAM)) scripts/describe
install: all
	install -d $(BINDIR) $(SHAREDIR)/mortise/examples $(SHAREDIR)/man/man1 $(SHAREDIR)/doc/mortise
	install -d $(SHAREDIR)/bash-completion/completions $(DESTDIR)$(ZSHDIR)
	install $(PROGRAM) $(BINDIR)/mortise
	install scripts/plot $(BINDIR)/mortise-plot
	install -d $(SHAREDIR)/mortise/python/mortise
	install -m 644 python/mortise/*.py $(SHAREDIR)/mortise/python/mortise
	install scripts/simplify $(BINDIR)/mortise-simplify
	install -m 644 scripts/simpler.py scripts/cutmesh.py $(SHAREDIR)/mortise/python
	install scripts/import $(BINDIR)/mortise-import
	install scripts/hpc/batch $(BINDIR)/mortise-batch
	install -m 644 scripts/hpc/slurm.sh $(SHAREDIR)/mortise/slurm.sh
	install -m 644 inputs/* $(SHAREDIR)/mortise/examples
	install -m 644 LICENSE README.md $(SHAREDIR)/doc/mortise
	$(DESCRIBE) schema > $(SHAREDIR)/mortise/scene.schema.json
	$(DESCRIBE) man > $(SHAREDIR)/man/man1/mortise.1
	$(DESCRIBE) bash > $(SHAREDIR)/bash-completion/completions/mortise
	$(DESCRIBE) zsh > $(DESTDIR)$(ZSHDIR)/_mortise

# The manual as a site, in out/manual: Markdown of docs/, and the reference from the program's own tables.
docs:
	@scripts/bootstrap mkdocs
	@$(MAKE) --no-print-directory -j2 all
	MORTISE=$(abspath $(PROGRAM)) scripts/manual build/manual
	mkdocs build -q

# ---- care of the source ------------------------------------------------------------------------------------------------

format:
	clang-format -i $(TRACKED)
format-check:
	clang-format --dry-run -Werror $(TRACKED)
floors:
	scripts/floors
lint: format-check floors
	bash -n scripts/bootstrap .ci/run
	scripts/sizes --check
	scripts/thresholds --check
sizes:
	scripts/sizes
	scripts/thresholds

clean:
	rm -rf build build-* bin out tests/.pytest_cache

-include $(OBJECTS:.o=.d) $(UNITS:=.d) $(BENCHES:=.d)
