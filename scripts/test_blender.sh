#!/usr/bin/env bash
# Tests the extension in the named Blender versions, as modules: from the checkout, then as a built zip with
# nothing but its bundled wheels. "make zip" must have run.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"

for version in "$@"; do
    if ! scripts/setup.sh has-python "$version"; then
        echo "NOT TESTED in Blender $version: its Python is not on this machine"
        continue
    fi
    echo "== Blender $version: the extension from the checkout"
    python="$(scripts/setup.sh bpy "$version")"
    "$python" -m pytest tests/addon
    echo "== Blender $version: the built zip with its bundled wheels"
    python="$(scripts/setup.sh bare "$version")"
    "$python" -m pytest tests/packaging
done
