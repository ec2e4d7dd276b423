#!/usr/bin/env bash
# Tests the solver with other libraries than those of .venv: what Windows on ARM gets, and the newest ones on newer
# Pythons. A deprecation is a failure. The arguments are pytest's (tests/solver).
#
# Where the machine has no Python 3.14, root gets Debian's, in a folder of its own (debootstrap, chroot): 300 MB.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"
cache="$(scripts/cache_folder.sh)"
tests=("$@")
[ "$#" -gt 0 ] || tests=(tests/solver)
options=(-W error::DeprecationWarning -W error::PendingDeprecationWarning -W error::FutureWarning
    -p no:cacheprovider)

# test_with PYTHON SET
test_with() {
    local python
    python="$(scripts/setup.sh libraries "$1" "$2")"
    echo "== Python $1, $2: $("$python" -m pip list --format freeze | grep -E '^(numpy|scipy|shapely)=' | paste -sd ' ')"
    "$python" -m pytest "${options[@]}" "${tests[@]}"
}

# The newest Debian, whose Python is 3.14, with the newest libraries in /libraries.
make_tree() {
    local tree="$1" platform platforms=()
    rm -rf "$tree"
    echo "making $tree (once)" >&2
    debootstrap --variant=minbase --include=ca-certificates,python3-venv sid "$tree" >&2
    for platform in manylinux_2_28 manylinux_2_27 manylinux_2_24 manylinux_2_17 manylinux2014; do
        platforms+=(--platform "${platform}_$(uname -m)")
    done
    "$(scripts/setup.sh solver)" -m pip download --quiet --disable-pip-version-check --only-binary=:all: \
        --implementation cp --python-version 3.14 "${platforms[@]}" --dest "$tree/wheels" \
        -r requirements/newest.txt -r requirements/test.txt >&2
    chroot "$tree" python3.14 -m venv /libraries
    chroot "$tree" sh -c '/libraries/bin/python -m pip install --quiet --no-index /wheels/*.whl' >&2
    cat requirements/newest.txt requirements/test.txt | cksum > "$tree/.curvefold-ready"
}

test_in_tree() {
    local tree="$cache/python-sid"
    [ "$(cat "$tree/.curvefold-ready" 2>/dev/null)" = "$(cat requirements/newest.txt requirements/test.txt | cksum)" ] \
        || make_tree "$tree"
    rm -rf "$tree/curvefold"
    mkdir "$tree/curvefold"
    tar --create --exclude-vcs --exclude=./.venv --exclude=./.cache --exclude=./out --exclude=./dist \
        --exclude=./wheels . | tar --extract --directory "$tree/curvefold"
    echo "== Python 3.14 in a folder of its own, newest"
    chroot "$tree" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/bin:/bin sh -c \
        'cd /curvefold && exec /libraries/bin/python -m pytest "$@"' sh "${options[@]}" "${tests[@]}"
}

test_with 3.11 bundled_windows_arm64
test_with 3.13 newest
if command -v python3.14 >/dev/null; then
    test_with 3.14 newest
elif [ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null; then
    test_in_tree
else
    echo "NOT TESTED on Python 3.14: it is not on this machine, and only root can have Debian's (debootstrap)"
fi
