# Build, test and package Polhode; each target installs what it needs into .venv. CONTRIBUTING.md lists the targets.
# Prerequisites: Python >= 3.11, Rust stable, make; for the viewer Node >= 20 and npm.

PYTHON ?= python3
BIN := .venv/bin
SOURCES := $(shell find crates -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock pyproject.toml

export PIP_CONSTRAINT := $(CURDIR)/constraints.txt
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PIP_QUIET := 1

VIEWER := python/polhode/_viewer/viewer.js

.PHONY: setup package demo test test-slow test-all lint bench evidence instructions docs wheel package-check viewer \
	check-viewer clean

setup: package
	@$(MAKE) --no-print-directory .venv/.tools

# The package and the viewer, built at the same time. Without Node or the WebAssembly target the viewer is left out.
package:
	@missing=$$(viewer/missing.sh); test -z "$$missing" || \
		echo "$$missing: the viewer was left out; everything else works without it."; \
	$(MAKE) --no-print-directory -j .venv/.built $$(test -n "$$missing" || echo viewer)

.venv/.python: constraints.txt pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Polhode needs Python >= 3.11; choose one with make PYTHON=python3.12" >&2; exit 1; }
	@command -v cargo >/dev/null || { echo "Polhode needs Rust: see https://rustup.rs" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install -q --upgrade pip
	$(BIN)/python -m pip install -q --group build
	@touch $@

# maturin installs the group `dev` unless another group is named.
.venv/.built: .venv/.python $(SOURCES)
	VIRTUAL_ENV=$(CURDIR)/.venv $(BIN)/maturin develop --release --locked --quiet --group build --extras plot
	@touch $@

# What tests, linters and guides need, in the environment that already holds polhode.
.venv/.tools: .venv/.python | .venv/.built
	$(BIN)/python -m pip install -q --group dev "polhode[scipy,io,plot,progress]"
	@touch $@

# The viewer: the core as WebAssembly, and one bundle that Python puts into pages and notebooks.
WASM_SOURCES := $(shell find crates/ga crates/rigid crates/wasm -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock .cargo/config.toml
WASM := $(or $(CARGO_TARGET_DIR),target)/wasm32-unknown-unknown/viewer/polhode_wasm.wasm
VIEWER_SOURCES := $(shell find viewer/src -type f) viewer/vite.config.ts docs/glossary.md $(wildcard examples/*.toml examples/*.stl examples/lessons/*.md)

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

demo: package
	@mkdir -p build/demo
	$(BIN)/polhode demo -o build/demo

# One worker more than processors, because tests of the page wait for the browser. A worker that has finished takes tests
# from another.
PYTEST = $(BIN)/python -m pytest --numprocesses $$($(BIN)/python -c "import os; print(os.cpu_count() + 1)") --dist worksteal

test: setup
	cargo test --quiet --locked --workspace --exclude polhode-py
	$(PYTEST) -m "not slow"

# What `make test` leaves out: further variants of what it tests.
test-slow: setup
	$(PYTEST) -m slow

test-all: test
	@$(MAKE) --no-print-directory test-slow

lint: setup
	cargo fmt --all --check
	cargo clippy --quiet --locked --workspace --all-targets -- -D warnings
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest polhode._native --allowlist .stubtest-allowlist
	@test -n "$$(viewer/missing.sh)" || $(MAKE) --no-print-directory check-viewer

# The libraries to compare with. constraints.txt gives all of them the same NumPy. One that is missing leaves its column
# empty, so benchmarks/run.py also runs after make setup alone.
.venv/.peers: .venv/.built .venv/.tools
	$(BIN)/python -m pip install -q "polhode[bench]"
	@touch $@

bench: .venv/.peers
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/accelerator.py
	cargo run --quiet --locked --release -p polhode-ga --example batch | tee build/bench-core.txt
	cargo run --quiet --locked --release -p polhode-rigid --example ensemble | tee build/bench-ensembles.txt

# One page of what the project claims, computed again: build/evidence.html.
evidence: .venv/.peers
	PYTHONPATH=benchmarks $(BIN)/python evidence/make.py

# Fails where a core kernel takes more instructions than it did; benchmarks/instructions.py --update after a change.
instructions: .venv/.python
	$(BIN)/python benchmarks/instructions.py

# Wheels for Linux with the viewer and the examples in them, and the source distribution. Built with zig, they need
# glibc >= 2.17, whatever version this machine has.
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
	test -z "$$left_out" || { echo "No wheels, because Rust's standard library is missing:$$left_out" >&2; exit 1; }

# What the registries will check: crates that build from their packages, the files of the npm package, and the metadata of
# the wheel of this machine and of the source distribution. Nothing is uploaded.
.venv/.package-check: .venv/.python
	$(BIN)/python -m pip install -q --group package-check
	@touch $@

package-check: package viewer .venv/.package-check
	cargo package --quiet --locked --allow-dirty -p polhode-ga -p polhode-rigid
	cd viewer && npm pack --dry-run --silent
	rm -rf build/package
	$(BIN)/maturin build --release --locked --quiet --out build/package
	$(BIN)/maturin sdist --out build/package
	$(BIN)/twine check --strict build/package/*

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
	rm -rf .venv build dist target viewer/node_modules python/polhode/_viewer/viewer.js python/polhode/_viewer/viewer.licenses.md
