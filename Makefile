# Everything a fresh machine needs is installed by scripts/setup.sh when it is first wanted.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.ONESHELL:
.PHONY: help demo test test-all test-gui test-kernel test-versions zip lint clean wheels

# The Blender that demo and test use, and all that test-all uses.
BLENDER := 5.0.1
BLENDERS := 4.2.23 4.5.15 5.0.1 5.2.3
DEMO := sample_patterns/corner_arcs.svg
# What test-versions tests: paths for pytest.
TESTS := tests/solver
# What test-gui runs in (trixie: 4.3, sid: 5.2), and where it writes the user guide's pictures, if anywhere.
export BLENDER_GUI := trixie
export GUIDE_PICTURES :=

help:
	@echo "make demo      fold and render a sample: out/demo.png, out/demo.blend, out/demo.json"
	@echo "make test      lint, solver, extension in Blender $(BLENDER), built zip"
	@echo "make test-all  the same in Blender $(BLENDERS)"
	@echo "make test-gui  a person's way through the extension, in a real Blender on a virtual screen (needs root)"
	@echo "make test-kernel  the compiled kernel under sanitizers, as a Windows library (Wine) and on ARM (qemu)"
	@echo "make test-versions  the solver with other libraries: the newest, and those of Windows on ARM"
	@echo "make zip       dist/curvefold-*.zip, one a platform"
	@echo "make lint      ruff and mypy"
	@echo "make clean     remove what was built (environments and downloads stay)"

demo:
	@python="$$(scripts/setup.sh bpy $(BLENDER))"
	rm -rf out/demo
	"$$python" -m curvefold_addon fold $(DEMO) --out out/demo --render out/demo.png --blend out/demo.blend
	cp out/demo/report.json out/demo.json
	echo "out/demo.png  out/demo.blend  out/demo.json"

lint:
	@scripts/lint.sh "$$(scripts/setup.sh solver)"

test: lint zip
	@python="$$(scripts/setup.sh solver)"
	"$$python" -m pytest tests/architecture tests/scripts tests/solver
	scripts/test_blender.sh $(BLENDER)

test-all: lint zip
	@python="$$(scripts/setup.sh solver)"
	"$$python" -m pytest tests/architecture tests/scripts tests/solver
	scripts/test_blender.sh $(BLENDERS)

test-gui: zip
	@"$$(scripts/setup.sh solver)" -m pytest -x -s tests/gui

test-kernel:
	@"$$(scripts/setup.sh solver)" scripts/check_kernel.py

# On Python 3.11, 3.13 and 3.14, as far as they can be had; half an hour each.
test-versions:
	@scripts/test_versions.sh $(TESTS)

wheels:
	@"$$(scripts/setup.sh solver)" scripts/wheels.py

zip: wheels
	@"$$(scripts/setup.sh bpy $(BLENDER))" scripts/build_zip.py

clean:
	@rm -rf out dist wheels .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find . -name __pycache__ -type d -not -path './.venv/*' -prune -exec rm -rf {} +
