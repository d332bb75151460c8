# Two commands on a fresh machine: `make demo` and `make test`. The same without make: docs/platforms.md.
PYTHON ?= python3
VENV := .venv
ifeq ($(OS),Windows_NT)
BIN := $(VENV)/Scripts
else
BIN := $(VENV)/bin
endif
STAMP := $(VENV)/.installed
# A file of tests stays with one process, which then makes its data once; long files are not kept for the end.
PYTEST := $(BIN)/python -m pytest -q -n auto --dist loadfile --no-loadscope-reorder
# Benchmarks measure one thread; the tests set their own.
bench: export PYTHONPATH := .
bench: export OMP_NUM_THREADS := 1
bench: export OPENBLAS_NUM_THREADS := 1

.PHONY: demo wheel studio test test-slow check lint unit bench fuzz mutants faults docs clean

demo: $(STAMP)  ## the bundled sample, into demo/
	$(BIN)/mmweaver generate --demo --out demo --overwrite

wheel: $(STAMP)  ## what users install, into dist/
	rm -rf build/lib  # files of an earlier build that are gone since would be packed, too
	$(BIN)/pip wheel --quiet --disable-pip-version-check --no-deps --no-build-isolation --wheel-dir dist .

test: $(STAMP)  ## exactly what CI runs: linters and tests side by side
	$(MAKE) --jobs=2 lint unit

check: test

test-slow: $(STAMP)  ## every night: all tests, those marked slow too, with the shapes of every call checked
	$(PYTEST) -m "slow or not slow" --check-every-call

lint: $(STAMP)
	$(BIN)/ruff check --quiet .
	$(BIN)/ruff format --quiet --check .
	$(BIN)/lint-imports --no-logo
	$(BIN)/ty check --no-progress --output-format concise --python $(VENV)

unit: $(STAMP)
	$(PYTEST)

SECONDS ?= 600
SEED ?= 0
fuzz: $(STAMP)  ## damaged files for every reader, for SECONDS; docs/security.md
	$(BIN)/python -m tests.fuzz --seconds $(SECONDS) --seed $(SEED)

COUNT ?= 100
mutants: $(STAMP)  ## breaks COUNT sampled lines one at a time: what do the tests notice? results/mutants.json; an hour or two
	$(BIN)/python -m tools.mutants.promises
	$(BIN)/python -m tools.mutants --seed $(SEED) --count $(COUNT)

bench: $(STAMP)
	$(BIN)/python benchmarks/physics.py
	$(BIN)/python benchmarks/inr_decode.py
	$(BIN)/python benchmarks/scatterer_decode.py
	$(BIN)/python benchmarks/mmw_encode.py
	$(BIN)/python benchmarks/weaver.py
	$(BIN)/python benchmarks/stream.py
	$(BIN)/python benchmarks/studio.py
	$(BIN)/python benchmarks/devices.py
	$(BIN)/python benchmarks/dataset.py
	$(BIN)/python benchmarks/dataset_store.py
	$(BIN)/python benchmarks/radar_dataset.py
	$(BIN)/python benchmarks/checksums.py
	$(BIN)/python benchmarks/recordings.py

faults: $(STAMP)  ## kills, full disks and failed writes at every event of every command that writes; an hour or more
	$(BIN)/python -m pytest -n 0 -m 'slow or not slow' tests/faults

studio:  ## builds the page's bundle from web/; needs Node, and only who changes the page needs it
	cd web && npm ci --no-audit --no-fund --ignore-scripts && npm run check && npm run build

docs: $(STAMP)  ## the site, into build/docs/site
	$(BIN)/pip install --quiet --editable '.[docs]'
	$(BIN)/python tools/build_docs.py

$(STAMP): pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable ".[dev]"
	touch $@

clean:
	rm -rf $(VENV) demo out build dist
