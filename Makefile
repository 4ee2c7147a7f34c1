# A fresh machine needs Python 3.10 to 3.13 and make: every target sets up .venv by itself.
#   make compare ARGS="--help"    passes options on;    make test PYTHON=python3.12    chooses the Python.

PYTHON ?= python3
ARGS ?=
BIN := .venv/bin
INSTALLED := .venv/.installed

.PHONY: help compare benchmark reproduce speed test slow pages lint docs format install clean
.DELETE_ON_ERROR:

help:
	@echo "make compare    train the agents, compare every controller, write tables and figures"
	@echo "make test       run the tests; make slow runs the slow ones"
	@echo "make pages      run the tests of the report and of the explorer in a headless Chromium"
	@echo "make reproduce  regenerate the thesis' tables and figures and judge its statements"
	@echo "make benchmark  every controller in every scenario on the same episodes"
	@echo "make speed      measure steps per second beside Gymnasium's CartPole"
	@echo "make lint       check style and types; make format puts the style right"
	@echo "make docs       build the documentation into build/site, warnings being errors"

compare benchmark reproduce speed: $(INSTALLED)
	$(BIN)/beamenv $@ $(ARGS)

test: $(INSTALLED)
	$(BIN)/python -m pytest $(ARGS)

slow: $(INSTALLED)
	$(BIN)/python -m pytest -m slow $(ARGS)

pages: $(INSTALLED)
	$(BIN)/python -m pytest -m slow tests/train/test_page_in_browser.py tests/train/test_explore_in_browser.py $(ARGS)

lint: $(INSTALLED)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

docs: $(INSTALLED)
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict

format: $(INSTALLED)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

install: $(INSTALLED)

clean:
	rm -rf .venv

# The constraint keeps torch at a release whose small CPU build is known to do; the published range stays open.
$(INSTALLED): pyproject.toml .ci/constraints.txt | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c .ci/constraints.txt -e '.[dev]'
	@touch $@

$(BIN)/python:
	@command -v $(PYTHON) >/dev/null || { echo "beamenv needs Python 3.10 to 3.13, but there is no '$(PYTHON)' here: name one with make PYTHON=..." >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 10) <= sys.version_info[:2] < (3, 14))' || { \
	  echo "beamenv needs Python 3.10 to 3.13, but '$(PYTHON)' is $$($(PYTHON) -V 2>&1): name another with make PYTHON=..." >&2; exit 1; }
	@$(PYTHON) -m venv --clear .venv || { rm -rf .venv; \
	  echo "'$(PYTHON) -m venv' failed: on Debian and Ubuntu, install the package python3-venv first." >&2; exit 1; }
	@echo "Installing into .venv: about two minutes, once."
