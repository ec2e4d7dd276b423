#!/usr/bin/env bash
# Runs ruff and mypy. Takes the Python of the solver's environment as its argument.
set -euo pipefail

python="$1"
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"

"$python" -m ruff check .
"$python" -m ruff format --check .

# The extension is one package, the checkout, and mypy can follow its relative imports only from outside. So it
# is looked at through links in a package with a name, and only solver and bridge: bpy has no types.
types="$root/out/types"
rm -rf "$types"
mkdir -p "$types/curvefold/curvefold_addon"
touch "$types/curvefold/__init__.py" "$types/curvefold/curvefold_addon/__init__.py"
ln -s "$root/solver" "$types/curvefold/solver"
ln -s "$root/curvefold_addon/bridge" "$types/curvefold/curvefold_addon/bridge"
cd "$types"
"$python" -m mypy --config-file "$root/pyproject.toml" --cache-dir "$root/.mypy_cache" -p curvefold
