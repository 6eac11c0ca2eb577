# make demo, make test, make bench, make docs, make lint, make wheel: each sets up what it needs.
# Prerequisites: Python >= 3.11, Rust stable, make; for the viewer Node >= 20 and npm.

PYTHON ?= python3
BIN := .venv/bin
SOURCES := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock pyproject.toml

export PIP_CONSTRAINT := $(CURDIR)/constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PIP_QUIET := 1

VIEWER := python/polhode/_viewer/viewer.js

.PHONY: setup demo test lint bench docs wheel viewer check-viewer clean

# Where what the viewer needs is missing, this says so, and all else goes on.
WITH_VIEWER = @missing=$$(viewer/missing.sh) && test -n "$$missing" && \
	echo "$$missing: the viewer was left out; all else works without it." || $(MAKE) --no-print-directory

setup: .venv/.built .venv/.tools
	$(WITH_VIEWER) viewer

.venv/.python: constraints.txt pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Polhode needs Python >= 3.11; say which with make PYTHON=python3.12" >&2; exit 1; }
	@command -v cargo >/dev/null || { echo "Polhode needs Rust: see https://rustup.rs" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -q --upgrade pip
	$(BIN)/python -m pip install -q --group build
	@touch $@

# Without a group named, maturin installs `dev`.
.venv/.built: .venv/.python $(SOURCES)
	VIRTUAL_ENV=$(CURDIR)/.venv $(BIN)/maturin develop --release --locked --quiet --group build --extras plot
	@touch $@

# What tests, linters and guides need. They join the same environment, which holds polhode already.
.venv/.tools: .venv/.python | .venv/.built
	$(BIN)/python -m pip install -q --group dev "polhode[scipy,io,plot,progress]"
	@touch $@

# The viewer: the core as WebAssembly, and one bundle that Python puts into pages and notebooks.
WASM_SOURCES := $(shell find crates/ga crates/rigid crates/wasm -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock
WASM := $(or $(CARGO_TARGET_DIR),target)/wasm32-unknown-unknown/viewer/polhode_wasm.wasm
VIEWER_SOURCES := $(shell find viewer/src -type f) viewer/vite.config.ts $(wildcard examples/*.toml examples/*.stl)

viewer: $(VIEWER)

viewer/node_modules/.installed: viewer/package-lock.json
	cd viewer && npm ci --silent
	@touch $@

$(WASM): $(WASM_SOURCES)
	@missing=$$(viewer/missing.sh); test -z "$$missing" || { echo "$$missing" >&2; exit 1; }
	cargo build --quiet --locked --profile viewer --target wasm32-unknown-unknown -p polhode-wasm
	@touch $@

$(VIEWER): $(WASM) viewer/node_modules/.installed $(VIEWER_SOURCES)
	cd viewer && npm run --silent build

check-viewer: viewer/node_modules/.installed
	cd viewer && npm run --silent check

demo: .venv/.built
	$(WITH_VIEWER) viewer
	@mkdir -p build/demo
	$(BIN)/polhode demo -o build/demo

test: setup
	cargo test --quiet --locked --workspace --exclude polhode-py
	$(BIN)/python -m pytest

lint: setup
	cargo fmt --all --check
	cargo clippy --quiet --locked --workspace --all-targets -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest polhode._native --allowlist .stubtest-allowlist
	$(WITH_VIEWER) check-viewer

# The peers join the same environment: with constraints.txt all agree on one NumPy. A peer that is missing is an empty
# column, so benchmarks/run.py also runs after make setup alone.
.venv/.peers: .venv/.built .venv/.tools
	$(BIN)/python -m pip install -q "polhode[bench]"
	@touch $@

bench: .venv/.peers
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/accelerator.py
	cargo run --quiet --locked --release -p polhode-ga --example batch | tee build/bench-core.txt
	cargo run --quiet --locked --release -p polhode-rigid --example ensemble | tee build/bench-ensembles.txt

# Wheels for Linux with the viewer and the examples in them, and the source distribution. By zig they run with glibc
# 2.17 and later, whatever this machine has.
.venv/.wheel: .venv/.python
	$(BIN)/python -m pip install -q --group wheel
	@touch $@

wheel: viewer .venv/.wheel
	rm -rf dist
	@left_out=; for machine in x86_64 aarch64; do \
		target=$$machine-unknown-linux-gnu; \
		if [ -d "$$(rustc --print target-libdir --target $$target 2>/dev/null)" ] || rustup target add $$target; then \
			echo "$$target"; \
			PATH="$(CURDIR)/$(BIN):$$PATH" maturin build --release --locked --quiet --zig --target $$target -o dist \
				|| exit 1; \
		else \
			left_out="$$left_out $$target"; \
		fi; \
	done; \
	$(BIN)/maturin sdist -o dist && ls dist; \
	test -z "$$left_out" || { echo "Left out, for want of Rust's library for it:$$left_out" >&2; exit 1; }

# The guides as pages, with the viewer in them, and the documentation of the core.
.venv/.docs: .venv/.tools
	$(BIN)/python -m pip install -q --group docs
	@touch $@

docs: setup .venv/.docs
	RUSTDOCFLAGS="-D warnings" cargo doc --quiet --locked --no-deps --workspace --exclude polhode-py
	$(BIN)/sphinx-build -q -W --keep-going -d build/doctrees docs build/docs
	@echo "The guides are build/docs/index.html."
	@echo "The documentation of the core is target/doc/polhode_ga/index.html and target/doc/polhode_rigid/index.html."

clean:
	rm -rf .venv build dist target viewer/node_modules python/polhode/_viewer/viewer.js
