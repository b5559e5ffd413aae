# From a clean clone: `make demo`, `make test`, `make check`. Needs Python >= 3.11, a C++20 compiler and make;
# everything else goes into .venv, once, and again when the package's recipe or its native part change.

NEW_ENOUGH := import sys; sys.exit(sys.version_info < (3, 11))
PYTHON ?= $(firstword $(foreach name,python3 python3.14 python3.13 python3.12 python3.11,\
	$(shell $(name) -c '$(NEW_ENOUGH)' 2>/dev/null && echo $(name))) python3)
JOBS ?= 2
BIN := .venv/bin
INSTALLED := .venv/.installed
RUNNING := .venv/.running
DOCUMENTING := .venv/.documenting

# Small problems on few cores: threads inside threads only get in each other's way.
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1
# Compiled once, not by each process of the tests anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test mutants check docs docs-test docs-outputs wheel format clean

demo: $(RUNNING)
	$(BIN)/plantar demo

# A file stays in one process, so that its fixtures are made once; tests/conftest.py puts the longest ones first.
test: $(INSTALLED)
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile --no-loadscope-reorder

# Do the tests notice? Careless changes one by one, in a copy of the source; ROOM=feet/fit takes those of one room.
mutants: $(INSTALLED)
	$(BIN)/python tests/mutants/run.py --jobs $(JOBS) --only "$(ROOM)"

check: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m pytest tests/test_architecture.py tests/test_docs.py tests/docs/test_site.py

# The site as it is published: out/site/index.html opens from disk. A warning, a dead link or a notebook that fails stops it.
docs: $(DOCUMENTING)
	rm -rf out/site
	$(BIN)/python -m sphinx -E -W --keep-going -q -b html docs out/site
	$(BIN)/python docs/extensions/check_site.py out/site

# Commands and snippets of the pages that play the twin: some minutes, so `make test` runs them on small made logs only.
docs-test: $(INSTALLED)
	$(BIN)/python -m pytest -m twin_pages tests/docs

# The outputs that those pages show, written anew.
docs-outputs: $(INSTALLED)
	$(BIN)/python tests/docs/write_outputs.py

# A release: sdist and wheel into dist, the wheel tried in a fresh environment without a compiler.
wheel:
	$(PYTHON) tests/release/try_wheel.py dist

format: $(INSTALLED)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

clean:
	rm -rf .venv build dist out .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find src tests -name __pycache__ -prune -exec rm -rf {} +

# What runs plantar, without what tests it: less to fetch.
$(RUNNING): pyproject.toml CMakeLists.txt $(wildcard cpp/* cpp/*/* cpp/*/*/*)
	@$(PYTHON) -c '$(NEW_ENOUGH)' || { echo "plantar needs Python >= 3.11: make PYTHON=/path/to/python3" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	test -e $(INSTALLED) || $(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[all]'
	touch $@

$(INSTALLED): pyproject.toml CMakeLists.txt $(wildcard cpp/* cpp/*/* cpp/*/*/*)
	@$(PYTHON) -c '$(NEW_ENOUGH)' || { echo "plantar needs Python >= 3.11: make PYTHON=/path/to/python3" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	touch $@

# What builds the site is no part of `.[dev]`: neither tests nor checks need it.
$(DOCUMENTING): $(INSTALLED)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	touch $@
