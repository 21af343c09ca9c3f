# Every chore, the same for a person, a hook and CI. `make help` lists them.
PYTHON ?= python3
BIN := .venv/bin
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
SOURCES := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml pyproject.toml

# The core in the page, and the sums by which the tests know that it is made of these sources.
PHYSICS := python/hersey/report/static/physics
PHYSICS_SOURCES := $(sort $(shell find crates/core/src crates/wasm/src -name '*.rs') crates/core/Cargo.toml \
  crates/wasm/Cargo.toml Cargo.toml)

WEB := wasm32-unknown-unknown
HAS_WEB := test -d "$$(rustc --print target-libdir --target $(WEB) 2>/dev/null)"
SUM_OF_SOURCES := cat $(PHYSICS_SOURCES) | sha256sum | cut -c1-64

# The core for C and for units of other tools, beside the room that packs them. Its name ends as the system's libraries do.
LIBRARY := python/hersey/exchange/library

.PHONY: help build physics demo demo-life docs test quick nightly lint format typecheck test-rust test-python browser lowest fuzz \
  fuzz-read benchmark mutants mutants-python mutants-rust library wheel release-check clean
.DEFAULT_GOAL := help

help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

build: .venv/built ## make .venv with hersey in it

physics: ## compile the core for the page anew (rustup target add wasm32-unknown-unknown)
	CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS="-C target-feature=+simd128 --remap-path-prefix=$(CURDIR)=. \
	  --remap-path-prefix=$${CARGO_HOME:-$$HOME/.cargo}=cargo --remap-path-prefix=$$(rustc --print sysroot)=rust" \
	  cargo build --quiet --profile web --target $(WEB) --package hersey-wasm $(BUILD_STD)
	install -m 644 $${CARGO_TARGET_DIR:-target}/$(WEB)/web/hersey_wasm.wasm $(PHYSICS).wasm
	@{ $(SUM_OF_SOURCES); sha256sum < $(PHYSICS).wasm | cut -c1-64; } > $(PHYSICS).sha256

.venv/tools: constraints.txt pyproject.toml
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv || \
	  { echo "this Python cannot make virtual environments: apt-get install python3-venv" >&2; exit 1; }
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt 'pip>=25.1' maturin
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --group dev
	@touch $@

.venv/built: .venv/tools $(SOURCES)
	@test "$$(head -n 1 $(PHYSICS).sha256)" = "$$($(SUM_OF_SOURCES))" || { $(HAS_WEB) && $(MAKE) --no-print-directory physics; } || \
	  echo "the page keeps its committed core, though the sources are others: make physics renews it" >&2
	PIP_CONSTRAINT=$(CURDIR)/constraints.txt $(BIN)/maturin develop --release --quiet
	$(MAKE) --no-print-directory library
	@$(BIN)/python -m compileall -q -j 0 python/hersey # as pip does: else a start compiles 200 modules where none are kept
	@touch $@

library: ## compile the core for C and put it into the package
	$(COMPILE) --release --quiet --package hersey-c -- -C strip=symbols
	@mkdir -p $(LIBRARY) && cd $${CARGO_TARGET_DIR:-target}/$(COMPILED) && for made in libhersey.so libhersey.dylib hersey.dll; do \
	  test ! -f $$made || install -m 755 $$made $(CURDIR)/$(LIBRARY)/$${made#lib}; done

demo: build ## run the main job on the shipped log
	mkdir -p build/demo
	$(BIN)/hersey report examples/bench.csv --machine examples/machine.toml --tare standing \
	  --out build/demo/report.html --figures build/demo/figures --force

demo-life: build ## follow the shipped life test of eight units to what ends them
	mkdir -p build/demo-life
	$(BIN)/hersey campaign add build/demo-life/life.hersey --table examples/life/runs.csv --means \
	  --machine examples/machine.toml
	$(BIN)/hersey life build/demo-life/life.hersey --machine examples/machine.toml \
	  --out build/demo-life/life.html --figures build/demo-life/figures --force

docs: build ## build the site of the docs, which needs no network, into build/docs/site
	$(BIN)/python -m website
	$(BIN)/python -m website.build build/docs

# What keeps one core busy goes beside what else does; then the tests of the package take all cores. Cargo does not share
# jobs with make: it would warn that it cannot.
test: build ## everything: lint, types, Rust and Python tests, the page in a browser
	$(MAKE) --no-print-directory --jobs=2 --output-sync=target lint typecheck test-rust
	$(MAKE) --no-print-directory test-python

lint: build ## check format and style
	$(BIN)/ruff format --check --quiet .
	$(BIN)/ruff check --quiet .
	cargo fmt --check
	env -u MAKEFLAGS cargo clippy --quiet --workspace --all-targets -- -D warnings

format: build ## put format and style right
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	cargo fmt

typecheck: build ## check types, and the stub against the bindings
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest hersey._core

test-rust: ## tests of the core, and of it for C
	env -u MAKEFLAGS cargo test --release --quiet --package hersey-core --package hersey-c

# Each worker begins with its part of the tests in their order, so that few files are shared, and then takes from others.
TESTED := PYTHONDONTWRITEBYTECODE= OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist worksteal

test-python: build browser ## tests of the package and the page
	$(TESTED)

quick: build ## the tests of the package that take a moment, while working
	$(TESTED) -m "not slow and not lasting" --ignore tests/browser

nightly: build browser ## every case of every test, then fuzzing and mutants (hours)
	$(TESTED) --nightly
	$(MAKE) --no-print-directory --keep-going fuzz fuzz-read mutants

# The page is tested in a real Chromium; Playwright drives the one of the system.
browser: ## install Chromium if there is none
	@command -v chromium >/dev/null || command -v chromium-browser >/dev/null || { \
	  root=$$(test "$$(id -u)" = 0 || echo sudo); \
	  $$root apt-get update -qq && $$root apt-get install -y -qq --no-install-recommends chromium >/dev/null; }

lowest: build ## the tests at the lowest versions of everything we depend on (minutes)
	rm -rf build/lowest && mkdir -p build && $(PYTHON) -m venv build/lowest
	$(BIN)/python tests/lowest.py pyproject.toml > build/lowest/constraints.txt
	build/lowest/bin/python -m pip install --quiet --disable-pip-version-check -c build/lowest/constraints.txt \
	  '.[figures,formats,sweep]' hypothesis lmfit pandas pytest pytest-xdist
	build/lowest/bin/python -m pip check
	build/lowest/bin/python -m pytest -n auto -m "not slow" --ignore tests/browser

fuzz: ## 100,000 random parameter sets through the motion core (minutes; FUZZ_SEED=1)
	cargo test --release --quiet --package hersey-core --test fuzz --test account -- --ignored --nocapture

# SEED, COUNT and MINUTES say which inputs, how many, and for how long at most; what fails is kept in build/fuzz.
SEED ?= 1
COUNT ?= 20000
MINUTES ?= 60
fuzz-read: build ## 20,000 damaged files through every reader (minutes; SEED=1 COUNT=20000 MINUTES=60)
	$(BIN)/python -m tests.untrusted_input.fuzz_read --seed $(SEED) --count $(COUNT) --minutes $(MINUTES)

mutants: mutants-python mutants-rust ## faults planted one by one: how many do the tests see? (hours)

# FILES='hersey.damping.design.*' takes one module, MOST=40 so many of each, CORES=16 so many at once. What is
# changed is a copy, laid out as src/, where mutmut looks for a package. Mutmut plants; its own runs stop at once.
FILES ?=
MOST ?= 1000000
CORES ?= $(shell nproc)
mutants-python: build ## the same in damping and verdict; FILES='hersey.damping.design.*' MOST=40 for some
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --group mutants
	rm -rf build/mutants && mkdir -p build/mutants
	cp -r tests examples pyproject.toml build/mutants && cp -r python build/mutants/src
	cd build/mutants && { $(CURDIR)/$(BIN)/python -m mutmut run nothing > run.txt 2>&1 || true; } && \
	  $(CURDIR)/$(BIN)/python -m mutmut results --all true > all.txt && \
	  $(CURDIR)/$(BIN)/python tests/mutants.py --most $(MOST) --cores $(CORES) $(FILES) < all.txt

mutants-rust: ## the same in the core's lubrication
	@test -x build/tools/bin/cargo-mutants || cargo install --locked --quiet --root build/tools cargo-mutants
	PATH="$(CURDIR)/build/tools/bin:$$PATH" cargo mutants --output build --jobs $(CORES) \
	  --file 'crates/core/src/lubrication/**' || true

benchmark: build ## ratios against peers and limits, printed and written to benchmarks/RESULTS.md (10 minutes)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt --group benchmark
	$(BIN)/python -m benchmarks.table

# With MANYLINUX=1 a wheel runs where glibc is 2.17 (2014) or later: zig links it. Else it runs where glibc is as new as here.
ifdef MANYLINUX
COMPILE = PATH=$(CURDIR)/build/packaging/$(SCRIPTS):$$PATH cargo-zigbuild rustc --target $(shell uname -m)-unknown-linux-gnu.2.17
COMPILED := $(shell uname -m)-unknown-linux-gnu/release
COMPATIBLE := --zig --compatibility manylinux2014
else
COMPILE := cargo rustc
COMPILED := release
endif

# One wheel serves Python 3.11 and later. It needs no .venv: what it is made with is in build/packaging. The package holds a
# copy of the example data only while it is packed.
WHEELS := build/wheels
SCRIPTS := bin# Scripts on Windows
SHIPPED := python/hersey/files/examples
VEGA := python/hersey/charts/vega-embed.js
build/packaging/installed:
	$(PYTHON) -m venv build/packaging
	build/packaging/$(SCRIPTS)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt \
	  altair cargo-zigbuild lazy-loader maturin numpy platformdirs vl-convert-python ziglang
	@touch $@

wheel: build/packaging/installed library ## build a wheel and a source archive into build/wheels (MANYLINUX=1: for older Linux)
	rm -rf $(WHEELS) $(SHIPPED) $(VEGA)
	@mkdir $(SHIPPED) && cp -r examples/life examples/*.csv examples/*.json examples/*.toml $(SHIPPED)
	@trap 'rm -rf $(SHIPPED) $(VEGA)' EXIT; export PATH="$(CURDIR)/build/packaging/$(SCRIPTS):$$PATH"; \
	  PYTHONPATH=python python -m hersey.charts.runtime $(VEGA) && \
	  maturin build --release --quiet $(COMPATIBLE) --out $(WHEELS) && \
	  maturin sdist --out $(WHEELS)
	@ls -l $(WHEELS)

release-check: wheel ## install the wheel where there is no Rust, and write a report with it; uploads nothing
	$(PYTHON) tests/release_check.py $(WHEELS)/hersey-*.whl build/release

clean: ## remove everything that was built
	rm -rf .venv build target Cargo.lock $(LIBRARY) $(SHIPPED) $(VEGA)
