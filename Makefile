# A fresh machine needs Python 3.10 to 3.13 and make: every target sets up .venv by itself.
#   make compare ARGS="--help"    passes options on;    make test PYTHON=python3.12    chooses the Python.

PYTHON ?= python3
ARGS ?=
JOBS ?= logical
PARALLEL = -n $(JOBS) --maxprocesses 8 --dist loadfile
BIN := .venv/bin
INSTALLED := .venv/.installed

# Libraries of others, each installed into an environment of its own beside this package, and what that takes.
CLIENTS := cleanrl minari rllib sbx skrl tianshou torchrl zoo
QUICK_CLIENTS := torchrl
REQUIRES_cleanrl := tensorboard setuptools
ALONE_cleanrl := cleanrl==1.2.0
REQUIRES_minari := minari[create,hdf5]>=0.5.3
REQUIRES_rllib := ray[rllib]>=2.54 stable-baselines3
REQUIRES_sbx := sbx-rl
REQUIRES_skrl := skrl
REQUIRES_tianshou := tianshou
REQUIRES_torchrl := torchrl
REQUIRES_zoo := rl_zoo3 requests
APART := build/apart

.PHONY: help compare benchmark reproduce speed test slow pages clients quick-clients lowest newest lint docs format install clean
.DELETE_ON_ERROR:

help:
	@echo "make compare    train the agents, compare every controller, write tables and figures"
	@echo "make test       run the tests; make slow runs the slow ones"
	@echo "make pages      run the tests of the report and of the explorer in a headless Chromium"
	@echo "make reproduce  regenerate the thesis' tables and figures and judge its statements"
	@echo "make benchmark  every controller in every scenario on the same episodes"
	@echo "make speed      measure steps per second beside Gymnasium's CartPole"
	@echo "make clients    run the libraries of others on the environment, each installed apart; make quick-clients: the quick ones"
	@echo "make lowest     install the lowest versions that are declared apart and run the tests; make newest: the newest"
	@echo "make lint       check style and types; make format puts the style right"
	@echo "make docs       build the documentation into build/site, warnings being errors"

compare benchmark reproduce speed: $(INSTALLED)
	$(BIN)/beamenv $@ $(ARGS)

# As many files of tests at a time as there are cores, each on one thread; JOBS=0 takes one after the other.
test: $(INSTALLED)
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest $(PARALLEL) $(ARGS)

slow: $(INSTALLED)
	$(BIN)/python -m pytest -m slow $(ARGS)

pages: $(INSTALLED)
	$(BIN)/python -m pytest -m slow tests/train/test_page_in_browser.py tests/train/test_explore_in_browser.py $(ARGS)

clients: quick-clients $(CLIENTS:%=client-%)

# Stable-Baselines3, skrl and Minari are in .venv, this without jax, which its own collector needs; the wheel is built, installed apart and used by scripts called train.py.
quick-clients: $(INSTALLED) $(QUICK_CLIENTS:%=client-%)
	$(BIN)/python -m pytest -m "slow or not slow" tests/clients tests/test_wings.py $(ARGS)

# torch as in .venv; else whatever the library itself asks for. cleanrl is scripts, whose release asks for a Gymnasium of long ago.
client-%: | $(BIN)/python
	@mkdir -p $(APART)
	@test -x $(APART)/$*/bin/python || $(BIN)/python -m venv $(APART)/$*
	@grep '^torch==' .ci/constraints.txt > $(APART)/torch.txt
	$(APART)/$*/bin/python -m pip install --quiet --disable-pip-version-check -c $(APART)/torch.txt torch pytest . $(foreach each,$(REQUIRES_$*),'$(each)')
	$(if $(ALONE_$*),$(APART)/$*/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --ignore-requires-python $(ALONE_$*))
	$(APART)/$*/bin/python -m pytest --confcutdir=tests/clients -m "slow or not slow" tests/clients/test_$*.py $(ARGS)

# Tools at the versions of .venv, what the package itself runs on at the lowest that pyproject.toml declares.
lowest: $(INSTALLED)
	@mkdir -p $(APART)
	@test -x $(APART)/lowest/bin/python || $(BIN)/python -m venv $(APART)/lowest
	$(BIN)/python .ci/bounds.py > $(APART)/lowest.txt
	$(APART)/lowest/bin/python -m pip install --quiet --disable-pip-version-check -c $(APART)/lowest.txt '.[dev]'
	OMP_NUM_THREADS=1 $(APART)/lowest/bin/python -m pytest -W default $(PARALLEL) $(ARGS)

newest: | $(BIN)/python
	@mkdir -p $(APART)
	@test -x $(APART)/newest/bin/python || $(BIN)/python -m venv $(APART)/newest
	@grep '^torch==' .ci/constraints.txt > $(APART)/torch.txt
	$(APART)/newest/bin/python -m pip install --quiet --disable-pip-version-check --upgrade -c $(APART)/torch.txt '.[dev]'
	OMP_NUM_THREADS=1 $(APART)/newest/bin/python -m pytest $(PARALLEL) $(ARGS)

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
