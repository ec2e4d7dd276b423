#!/usr/bin/env bash
# Makes the virtual environments that the Makefile uses, and prints the path of the Python in them.
#
#   scripts/setup.sh solver               .venv in the tree: solver, tests, linters; no Blender
#   scripts/setup.sh bpy VERSION          Blender VERSION as a module, with the solver's libraries and pytest
#   scripts/setup.sh bare VERSION         the same without scipy, shapely, svgelements and the compiled kernel,
#                                         which must then come from the wheels in a built extension
#   scripts/setup.sh libraries PYTHON SET  the solver's libraries that requirements/SET.txt names, and pytest, for
#                                         that Python: newest, or bundled_windows_arm64 with the numpy of Blender
#   scripts/setup.sh has-python VERSION   exit 0 when a Python that Blender VERSION needs is there
#
# Everything but .venv lives in the folder that scripts/cache_folder.sh names. A finished environment is used
# again until what it is made of changes.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cache="$("$root/scripts/cache_folder.sh")"
export PIP_DISABLE_PIP_VERSION_CHECK=1

say() { printf '%s\n' "$*" >&2; }
die() { say "curvefold: $*"; exit 1; }

# Debian packages: installed when we may, named when we may not.
need_packages() {
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        say "installing system packages: $*"
        { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@"; } \
            >&2 || die "please install these packages: $*"
    else
        die "please install these packages: $*"
    fi
}

# Runs python, so that a launcher without an interpreter behind it does not count.
python_is() { "$1" -c "import sys; sys.exit(not ($2))" >/dev/null 2>&1; }

# find_python CONDITION NAME...: the first of the named commands (or their siblings kept by pyenv) that runs
# and meets the condition on sys.version_info.
find_python() {
    local condition="$1" name candidate pyenv=~/.pyenv
    shift
    for name in "$@"; do
        for candidate in "$name" "/usr/bin/$name" "/usr/local/bin/$name" \
            "${PYENV_ROOT:-$pyenv}"/versions/*/bin/"$name"; do
            command -v "$candidate" >/dev/null 2>&1 || continue
            if python_is "$candidate" "$condition"; then
                command -v "$candidate"
                return 0
            fi
        done
    done
    return 1
}

find_solver_python() {
    find_python "(3, 11) <= sys.version_info < (3, 14)" python3.11 python3 python3.12 python3.13
}

blender_python_version() {
    case "$1" in
        4.*|5.0.*) echo "3.11" ;;
        *) echo "3.13" ;;
    esac
}

# The numpy inside the official build of each Blender; the bundled libraries must run on it.
blender_numpy_version() {
    case "$1" in
        4.2.*) echo "1.24.3" ;;
        4.*|5.0.*) echo "1.26.4" ;;
        *) echo "2.3.4" ;;
    esac
}

find_blender_python() {
    local version
    version="$(blender_python_version "$1")"
    find_python "sys.version_info[:2] == (${version/./, })" "python$version" python3
}

# make_environment FOLDER PYTHON STAMP PIP-ARGUMENT...
make_environment() {
    local folder="$1" python="$2" stamp="$3"
    shift 3
    if [ -x "$folder/bin/python" ] && [ "$(cat "$folder/.curvefold-ready" 2>/dev/null)" = "$stamp" ]; then
        return
    fi
    mkdir -p "$(dirname "$folder")"
    if ! "$python" -c "import ensurepip, venv" 2>/dev/null; then
        need_packages "python$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')-venv"
    fi
    say "making $folder (once)"
    rm -f "$folder/.curvefold-ready"
    if [ ! -x "$folder/bin/python" ] || ! "$folder/bin/python" -m pip --version >/dev/null 2>&1; then
        "$python" -m venv --clear "$folder" >&2
    fi
    "$folder/bin/python" -m pip install --quiet --upgrade pip >&2 || say "keeping the pip that came with Python"
    "$folder/bin/python" -m pip install --quiet --find-links "$cache/wheels" "$@" >&2 \
        || die "could not install into $folder: pip $*"
    printf '%s' "$stamp" > "$folder/.curvefold-ready"
}

# The Debian packages of the shared libraries that Blender is linked to.
library_package() {
    case "$1" in
        libX11.so*) echo libx11-6 ;;
        libXext.so*) echo libxext6 ;;
        libXrender.so*) echo libxrender1 ;;
        libXfixes.so*) echo libxfixes3 ;;
        libXi.so*) echo libxi6 ;;
        libxkbcommon.so*) echo libxkbcommon0 ;;
        libSM.so*) echo libsm6 ;;
        libICE.so*) echo libice6 ;;
        libGL.so*) echo libgl1 ;;
        libEGL.so*) echo libegl1 ;;
        libXxf86vm.so*) echo libxxf86vm1 ;;
        libgomp.so*) echo libgomp1 ;;
        *) echo "(the package of $1)" ;;
    esac
}

check_libraries() {
    local folder="$1" library missing=()
    command -v ldd >/dev/null || return 0
    while read -r library; do
        missing+=("$(library_package "$library")")
    done < <(ldd "$folder"/lib/python3.*/site-packages/bpy/__init__*.so 2>/dev/null \
        | awk '/not found/ && $1 !~ /^\// {print $1}' | sort -u)
    if [ "${#missing[@]}" -gt 0 ]; then
        case "${missing[*]}" in
            *"(the package"*) die "please install the packages of these libraries: ${missing[*]}" ;;
        esac
        need_packages "${missing[@]}"
    fi
}

# install_kernel FOLDER: the compiled kernel, which is an option; without it numpy and scipy do its work.
install_kernel() {
    local folder="$1" wheel
    if [ "${CURVEFOLD_KERNEL:-}" = 0 ] || ! wheel="$("$folder/bin/python" "$root/scripts/kernel_wheels.py" here)"; then
        say "going on without the compiled kernel"
        return
    fi
    [ "$(cat "$folder/.curvefold-kernel" 2>/dev/null)" = "$(basename "$wheel")" ] && return
    rm -f "$folder/.curvefold-kernel"
    if "$folder/bin/python" -m pip install --quiet --no-deps --no-index --force-reinstall "$wheel" >&2; then
        basename "$wheel" > "$folder/.curvefold-kernel"
    else
        say "going on without the compiled kernel: pip could not install $wheel"
    fi
}

checksum() { cat "$@" | cksum; }

wheel_folder() { mkdir -p "$cache/wheels"; }

kind="${1:-}"
version="${2:-}"
requirements="$root/requirements"
# What .venv and the Blenders are made of.
usual=("$requirements"/{bundled,dev,test}.txt)
wheel_folder
case "$kind" in
    solver)
        folder="$root/.venv"
        if [ ! -x "$folder/bin/python" ]; then
            python="$(find_solver_python)" || {
                need_packages python3 python3-venv
                python="$(find_solver_python)" || die "Python 3.11, 3.12 or 3.13 is needed"
            }
        else
            python="$folder/bin/python"
        fi
        make_environment "$folder" "$python" "$(checksum "${usual[@]}")" -r "$requirements/dev.txt"
        install_kernel "$folder"
        ;;
    bpy|bare)
        [ -n "$version" ] || die "which Blender? scripts/setup.sh $kind VERSION"
        python="$(find_blender_python "$version")" || {
            need_packages "python$(blender_python_version "$version")" \
                "python$(blender_python_version "$version")-venv"
            python="$(find_blender_python "$version")" \
                || die "Blender $version needs Python $(blender_python_version "$version")"
        }
        numpy="numpy==$(blender_numpy_version "$version")"
        packages=("bpy==$version" "$numpy" -r "$requirements/test.txt")
        folder="$cache/bpy-$version"
        if [ "$kind" = bare ]; then
            folder="$cache/bpy-$version-bare"
        else
            packages+=(-r "$requirements/bundled.txt")
        fi
        make_environment "$folder" "$python" "$numpy $(checksum "${usual[@]}")" "${packages[@]}"
        [ "$kind" = bare ] || install_kernel "$folder"
        check_libraries "$folder"
        ;;
    libraries)
        set="${3:-}"
        [ -f "$requirements/$set.txt" ] || die "which libraries? scripts/setup.sh libraries PYTHON SET"
        python="$(find_python "sys.version_info[:2] == (${version/./, })" "python$version" python3)" \
            || die "Python $version is not on this machine"
        packages=(-r "$requirements/$set.txt" -r "$requirements/test.txt")
        # The extension bundles no numpy: that is Blender's.
        [ "$set" = newest ] || packages+=("numpy==$(blender_numpy_version 5.0.1)")
        folder="$cache/$set-$version"
        make_environment "$folder" "$python" "$(checksum "$requirements/$set.txt" "$requirements/test.txt")" \
            "${packages[@]}"
        ;;
    has-python)
        find_blender_python "$version" >/dev/null
        exit
        ;;
    *)
        die "scripts/setup.sh solver | bpy VERSION | bare VERSION | libraries PYTHON SET | has-python VERSION"
        ;;
esac
printf '%s\n' "$folder/bin/python"
