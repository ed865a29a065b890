# Tasks; each sets up what it needs in .venv and build, and a second call installs nothing again.
#
#   make demo       the 30310 test bearing at 3000 rpm, in demo/
#   make test       C unit tests and the Python tests in two processes (PYTEST="-k film" narrows them; SLOW=1 adds the slow ones; JOBS=4)
#   make lint       style, types, layers of the package, rules of the C sources (make format rewrites the style)
#   make bench      every script in benchmarks/, results in build/bench (BENCH="name name" picks some, QUICK=1 shortens them; SMOKE=1: seconds each, side by side)
#   make stability  the table of hard scenes, minutes long, JSON in build/stability.json (SCENES="name name" picks some)
#   make notebooks  the notebooks run and keep their outputs
#   make adversary  random scenes for a time, each judged; failures are shrunk and kept (MINUTES=20, SEED=0)
#   make fuzz       damaged results, checkpoints and case files (MINUTES=10, SEED=0); fuzz targets of the C core under sanitizers, 60 s
#                   each (SECONDS=600), for which it needs clang
#   make sanitize   the C tests and the Python tests that reach all of the C code, under address and undefined-behaviour sanitizers
#   make cross      the core and its C tests for Windows, aarch64 and macOS; where a system can be had here, the tests run; minutes long
#   make docs       the documentation site in build/docs, ready to host (make site is the same); its code is run, and a page whose inputs
#                   are those of the last run is not run again; warnings are errors (CHECK=1 leaves out the pages of the sources)
#   make figures    the pictures of README and site are made again (FIGURES="report.png" picks some); needs Chromium
#   make wheels     a source distribution and a wheel in dist/, audited and tried in an empty environment
#   make mutate     small faults put into a copy of the sources: how many do the tests notice? (COUNT=250 MINUTES=90 SEED=1)
#   make count      how many lines the sources have, by folder
#   make walk       which files of csrc a right-hand side passes through, with the functions of each (gcc and gcov)
#   make core       libtrbdyn without Python, installed in build/core, and the example in C compiled with it and run
#   make install    only the environment and the package
#   make clean      remove what was built; make distclean: .venv too
#
# PYTHON=... picks the Python, SUNDIALS_ROOT=... the SUNDIALS, WERROR=OFF lets a new compiler's warnings pass.

PYTHON ?= python3
WERROR ?= ON
PYTEST ?=
SLOW   ?=
JOBS   ?= 2
QUICK  ?=
CHECK  ?=
SMOKE  ?=
BENCH  ?= $(filter-out common bit_identity paired,$(basename $(notdir $(wildcard benchmarks/*.py))))

VENV    := .venv
PY      := $(VENV)/bin/python
PIP     := $(PY) -m pip --disable-pip-version-check
SOURCES := $(shell find csrc -type f)
TIDY    := $(wildcard $(patsubst %,csrc/%/*.c,base laws surface bearing body contact system motion stepping python))
STYLED  := $(wildcard csrc/*/*.[ch])
# Python tests that with the C tests run nearly every line of the C sources; the leak tests count a memory that sanitizers keep
SANITIZED := $(addprefix tests/,laws/test_in_contacts.py laws/test_extremes.py api/test_laws_api.py \
  $(addprefix laws/test_oracles.py::test_,flooded_gaps_are_booked supply_and_hysteresis_are_booked) \
  $(addprefix geometry/test_,derived.py equilibrium.py interference.py pocket.py) api/test_simulation.py api/test_pockets.py \
  $(addprefix physics/test_,looking.py contacts.py effects.py) \
  $(addprefix physics/test_spacer.py::test_,two_methods_agree unloaded_rollers_are_said) fuzz/test_bad_input.py \
  $(addprefix restart/test_checkpoints.py::test_,runs_in_pieces_follow_one_schedule every_run_that_ended_early_goes_on) \
  $(addprefix convergence/test_determinism.py::test_,records_do_not_depend_on_each_other restarts_are_exact instruction_sets_agree \
    a_start_from_a_state_under_changing_loads))
# of these files: what stays in Python, and long runs through what others have entered
UNSANITIZED := any_key_of_a_case or any_value or any_options or any_text or no_field_is_left_out or held_by_the_running or planar_freezes
PACKAGES := 'import sysconfig; print(sysconfig.get_path("platlib"))'
DEFINES := -C cmake.define.TRB_WERROR=$(WERROR) -C cmake.define.TRB_BUILD_TESTS=ON

export MPLBACKEND := Agg
# tests and pages start hundreds of processes: without bytecode each compiles the package again, 0.8 s
unexport PYTHONDONTWRITEBYTECODE

.PHONY: core count walk cross demo site docs figures wheels test lint format bench stability notebooks fuzz sanitize mutate adversary install clean distclean
.NOTPARALLEL:

demo: install
	$(PY) -m trbdyn demo -o demo --overwrite

site: docs

docs: install $(VENV)/.docs
	$(PY) -m sphinx -j $(JOBS) $(if $(CHECK),-t check) -W --keep-going -b html -d build/docs-cache docs build/docs
	@echo "build/docs/index.html"

figures: install $(VENV)/.test
	$(PY) docs/figures.py $(FIGURES)

wheels: install
	.ci/wheels

test: install $(VENV)/.test
	$(VENV)/bin/ctest --test-dir build/package -j $(JOBS) --output-on-failure --no-tests=ignore
	$(PY) -m pytest tests notebooks --nbmake -n $(JOBS) --dist loadfile --no-loadscope-reorder --max-worker-restart 0 $(if $(SLOW),-m "slow or not slow") $(PYTEST)

lint: $(VENV)/.lint build/.package
	$(PY) -m ruff check .
	$(PY) -m ruff format --check .
	$(PY) -m mypy
	$(VENV)/bin/lint-imports --no-cache >build/imports.log 2>&1 || { cat build/imports.log; exit 1; }
	$(PY) .ci/lint_imports.py
	$(VENV)/bin/clang-format --dry-run -Werror $(STYLED)
	$(PY) .ci/lint_c.py --objects build/package
	$(VENV)/bin/clang-tidy -p build/package --quiet $(TIDY) >build/tidy.log 2>&1 || { cat build/tidy.log; exit 1; }

format: $(VENV)/.lint
	$(PY) -m ruff check --fix .
	$(PY) -m ruff format .
	$(VENV)/bin/clang-format -i $(STYLED)

bench: install $(VENV)/.test
	@mkdir -p build/bench
ifdef SMOKE
	@printf '%s\n' $(BENCH) | xargs -P $(JOBS) -I NAME sh -c 'began=$$(date +%s); $(PY) benchmarks/NAME.py --smoke --no-picture \
	  --json build/bench/NAME.json >build/bench/NAME.log 2>&1 || { echo "NAME fails:"; tail -20 build/bench/NAME.log; exit 1; }; \
	  echo "NAME: $$(($$(date +%s) - began)) s"'
	@rm -rf build/bench/paper
	@$(PY) benchmarks/paper --smoke --quiet -o build/bench/paper >build/bench/paper.log 2>&1 || { tail -20 build/bench/paper.log; exit 1; }
else
	@set -e; for name in $(BENCH); do echo "== $$name"; \
	  $(PY) benchmarks/$$name.py $(if $(QUICK),--quick) --json build/bench/$$name.json; done
endif

stability: install $(VENV)/.test
	@mkdir -p build
	$(PY) tests/stability/stability.py --json build/stability.json $(SCENES)

notebooks: install $(VENV)/.test
	$(PY) -m pytest notebooks --nbmake --overwrite

fuzz: install
	$(PY) tests/fuzz/fuzz_files.py --minutes $(or $(MINUTES),1) --seed $(or $(SEED),0)
	SECONDS_EACH=$(or $(SECONDS),60) .ci/fuzz

adversary: install
	$(PY) tests/adversary/adversary.py --minutes $(or $(MINUTES),20) --seed $(or $(SEED),0) --keep --json build/adversary.json

mutate: install $(VENV)/.test
	$(PY) tests/mutation/mutate.py --count $(or $(COUNT),250) --minutes $(or $(MINUTES),90) --seed $(or $(SEED),1)

count:
	@$(PYTHON) .ci/count.py

walk: install
	@$(PY) .ci/walk.py

install: build/.package

core: $(VENV)/.tools
	@$(VENV)/bin/cmake -S csrc -B build/core-build -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(VENV)/bin/ninja \
	  -DTRB_BUILD_MODULE=OFF -DTRB_WERROR=$(WERROR) -DCMAKE_INSTALL_PREFIX=$(CURDIR)/build/core -DPython_ROOT_DIR=$(CURDIR)/$(VENV) >build/core.log
	@$(VENV)/bin/cmake --build build/core-build >>build/core.log || { tail -20 build/core.log; exit 1; }
	@$(VENV)/bin/cmake --install build/core-build >>build/core.log
	@$(VENV)/bin/cmake -S examples/c -B build/core-example -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(VENV)/bin/ninja \
	  -DCMAKE_PREFIX_PATH=$(CURDIR)/build/core >>build/core.log
	@$(VENV)/bin/cmake --build build/core-example >>build/core.log || { tail -20 build/core.log; exit 1; }
	@build/core-example/orbit

cross:
	.ci/cross

# In an environment of its own, which finds the sanitized package and the other packages of .venv, but not its editable install;
# -P: without the folder of the sources before them.
sanitize: $(VENV)/.test
	$(PIP) -q install --no-build-isolation --no-deps --upgrade --target build/sanitize/site \
	  -C build-dir=build/sanitize/package -C cmake.define.TRB_WERROR=OFF \
	  -C cmake.define.TRB_BUILD_TESTS=ON -C cmake.define.TRB_SANITIZE=ON -C cmake.build-type=RelWithDebInfo .
	$(VENV)/bin/ctest --test-dir build/sanitize/package --output-on-failure --no-tests=ignore
	$(PY) -m venv --without-pip build/sanitize/venv
	printf '%s\n' "$(CURDIR)/build/sanitize/site" "$$($(PY) -c $(PACKAGES))" \
	  >"$$(build/sanitize/venv/bin/python -c $(PACKAGES))/sanitized.pth"
	export LD_PRELOAD="$$($${CC:-cc} -print-file-name=libasan.so) $$($${CC:-cc} -print-file-name=libubsan.so)" ASAN_OPTIONS=detect_leaks=0; \
	  build/sanitize/venv/bin/python -P -c 'import trbdyn._core as core; assert "/build/sanitize/site/" in core.__file__, core' && \
	  build/sanitize/venv/bin/python -P -m pytest -p no:cacheprovider -k "not ($(UNSANITIZED))" $(SANITIZED) $(PYTEST)

clean:
	rm -rf build demo .pytest_cache .mypy_cache .ruff_cache
	find trbdyn tests benchmarks -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean
	rm -rf $(VENV)

# the environment: build tools and what the package needs; then what its tests and benchmarks need
$(VENV)/.tools: pyproject.toml .ci/system .ci/requirements.py
	@PYTHON=$(PYTHON) .ci/system
	@test -x $(PY) || { echo "making $(VENV)"; $(PYTHON) -m venv $(VENV); }
	@echo "installing what the package needs"
	@mkdir -p build
	@$(PY) .ci/requirements.py build dependencies >build/requirements.txt
	@$(PIP) -q install -r build/requirements.txt
	@touch $@

$(VENV)/.test: $(VENV)/.tools
	@echo "installing what the tests need"
	@mkdir -p build
	@$(PY) .ci/requirements.py test >build/requirements-test.txt
	@$(PIP) -q install -r build/requirements-test.txt
	@touch $@

$(VENV)/.lint: $(VENV)/.test
	@mkdir -p build
	@$(PY) .ci/requirements.py lint >build/requirements-lint.txt
	@$(PIP) -q install -r build/requirements-lint.txt
	@touch $@

$(VENV)/.docs: $(VENV)/.tools
	@echo "installing what the documentation needs"
	@mkdir -p build
	@$(PY) .ci/requirements.py docs >build/requirements-docs.txt
	@$(PIP) -q install -r build/requirements-docs.txt
	@touch $@

# The package as an editable install: .venv imports the Python sources of trbdyn/ and finds the compiled core beside its other packages,
# from any folder. build/package stays, so that only what changed is compiled again.
build/.package: $(VENV)/.tools $(SOURCES)
	@echo "building the package"
	@mkdir -p build
	@$(PIP) -q install --no-build-isolation --no-deps --force-reinstall -C build-dir=build/package $(DEFINES) -e .
	@cat build/package/sundials.txt
	@touch $@
