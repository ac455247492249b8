# Every target builds and installs the package into its own virtual environment first.
# Needs Python 3.11 or later, pip and a Rust toolchain; PYTHON and VENV can be overridden.

PYTHON ?= python3
VENV   ?= .venv
BIN    := $(VENV)/bin
PYTEST := $(BIN)/python -m pytest -n auto --dist loadfile --no-loadscope-reorder

# Cargo shares the cores by itself; it would warn of a job server that it cannot reach.
unexport MAKEFLAGS MFLAGS

# As maturin does: the binding crate is loaded by an interpreter, not linked with one.
export PYO3_BUILD_EXTENSION_MODULE = 1

.PHONY: build develop hooks test test-rust test-fast evidence test-ros lint lint-rust lint-python bench docs images fuzz check reproduce clean

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

# Nothing is packed and installed again while no source is newer; folders tell of files that are gone.
SOURCES := $(shell find crates python Cargo.toml Cargo.lock pyproject.toml README.md \
    -not -name '*.so' -not -name '*.pyc' -not -name __pycache__)

$(VENV)/installed: $(SOURCES) | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check ".[report,cli,test,dev,docs]"
	touch $@

build: $(VENV)/installed

# Builds the native module into the source tree, for work on the package itself; incremental.
develop: build
	CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 CARGO_PROFILE_RELEASE_INCREMENTAL=true \
	    VIRTUAL_ENV=$(abspath $(VENV)) $(BIN)/maturin develop --release --quiet

# Formatters and lints before each commit.
hooks: build
	$(BIN)/python -m pip install --quiet --disable-pip-version-check pre-commit
	$(BIN)/pre-commit install

# The native module is compiled on one core for minutes, and Python waits for it: tests in Rust take what is left.
test:
	$(MAKE) -j2 build test-rust
	$(PYTEST) -m "not evidence"

test-rust:
	nice cargo test --workspace --locked

# What fails first when a formula, a message or a name is wrong: units in Rust, and the quick files.
test-fast: build
	cargo test --workspace --locked --lib
	$(PYTEST) --fast -m "not evidence"

# What the documents publish, computed again: when a core or its data changed, and before a release.
evidence: build
	$(PYTEST) -m evidence

# Two processes on ROS 2 itself, whose wheels (Linux x86-64, CPython 3.11) stand apart from everything else.
ROS_VENV ?= .venv-ros

test-ros: build
	$(PYTHON) -m venv $(ROS_VENV)
	$(ROS_VENV)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r tests/ros/requirements.txt
	HRSAFETY_ROS_PYTHON=$(abspath $(ROS_VENV))/bin/python $(BIN)/python -m pytest tests/ros

lint: lint-rust lint-python

lint-rust:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked -- -D warnings

lint-python: build
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --strict python/hrsafety
	PATH=$(abspath $(BIN)):$$PATH $(BIN)/python crates/hrsafety_py/make_stub.py --check
	$(BIN)/python -m mypy.stubtest hrsafety._hrsafety

docs: build
	$(BIN)/sphinx-build -W --keep-going -j auto -b html docs target/docs
	$(BIN)/python docs/check_links.py target/docs

# Each waits for one core part of the time.
check: build
	$(MAKE) -j3 --output-sync=target lint-rust lint-python docs

# RECORDING names a table of recorded people for the gallery.
RECORDING ?= zara01.csv

images: build
	$(BIN)/python docs/make_images.py $(RECORDING)

# Random inputs to constructors, functions and readers: half an hour on two cores for ten million.
INPUTS ?= 10000000
SEED   ?= 1

fuzz: build
	$(BIN)/python -m tests.fuzz --inputs $(INPUTS) --seed $(SEED)

bench: build
	cargo bench --workspace --locked
	$(BIN)/python -m pytest benches

reproduce: build
	$(BIN)/hrsafety reproduce

clean:
	rm -rf .venv target
