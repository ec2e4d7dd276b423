#!/usr/bin/env bash
# A real Blender, with windows, for tests/gui: Debian's, in a folder of its own, under a virtual screen.
#
#   scripts/blender_gui.sh tree SUITE            makes the folder once and prints its path
#   scripts/blender_gui.sh run SUITE WORK ARG…   becomes that Blender, on the screen $DISPLAY, with its home and
#                                                user folder in WORK, a path inside the folder
#
# SUITE is trixie (Blender 4.3) or sid (5.2). The folder is made and entered by debootstrap and chroot, which
# only root may use. It takes 1.6 GB in the folder that scripts/cache_folder.sh names, and one to three minutes.
set -euo pipefail

cache="$("$(dirname "${BASH_SOURCE[0]}")/cache_folder.sh")"

say() { printf '%s\n' "$*" >&2; }
die() { say "curvefold: $*"; exit 1; }

# What has to be on the machine itself: command and Debian package.
need_commands() {
    local missing=() pair
    for pair in debootstrap:debootstrap Xvfb:xvfb xdotool:xdotool import:imagemagick; do
        command -v "${pair%%:*}" >/dev/null || missing+=("${pair##*:}")
    done
    [ "${#missing[@]}" = 0 ] && return
    command -v apt-get >/dev/null || die "please install these packages: ${missing[*]}"
    say "installing system packages: ${missing[*]}"
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
        "${missing[@]}"; } >&2 || die "please install these packages: ${missing[*]}"
}

make_tree() {
    local suite="$1" folder="$2"
    local packages=(blender python3-numpy libgl1-mesa-dri libegl1 libgl1)
    # Python 3.14, for which the bundled wheels do not exist: there the libraries are Debian's.
    [ "$suite" = sid ] && packages+=(python3-cattr python3-requests python3-scipy python3-shapely)
    say "making $folder (once)"
    rm -rf "$folder"
    debootstrap --variant=minbase --include=ca-certificates "$suite" "$folder" >&2 \
        || die "debootstrap could not make a Debian $suite in $folder"
    # A snapshot of sid may be older than its date says.
    printf 'APT::Install-Recommends "false";\nAcquire::Check-Valid-Until "false";\n' \
        > "$folder/etc/apt/apt.conf.d/99curvefold"
    printf 'path-exclude=/usr/share/%s/*\n' doc man locale > "$folder/etc/dpkg/dpkg.cfg.d/99curvefold"
    { chroot "$folder" apt-get update -qq \
        && DEBIAN_FRONTEND=noninteractive chroot "$folder" apt-get install -y -qq "${packages[@]}" \
        && chroot "$folder" apt-get clean; } >&2 || die "could not install Blender in $folder"
    chroot "$folder" blender --version >&2 || die "Blender does not start in $folder"
    touch "$folder/.curvefold-ready"
}

verb="${1:-}"
suite="${2:-}"
case "$suite" in
    trixie | sid) ;;
    *) die "scripts/blender_gui.sh tree SUITE | run SUITE WORK ARG…, where SUITE is trixie or sid" ;;
esac
[ "$(id -u)" = 0 ] || die "a Blender in a folder of its own needs root (debootstrap, chroot)"
tree="$cache/blender-$suite"

case "$verb" in
    tree)
        need_commands
        [ -e "$tree/.curvefold-ready" ] || make_tree "$suite" "$tree"
        printf '%s\n' "$tree"
        ;;
    run)
        work="$3"
        shift 3
        # Autosave goes to the temporary folder, so that is one of the run's own too.
        exec chroot "$tree" env -i DISPLAY="${DISPLAY:?}" PATH=/usr/bin:/bin LANG=C.UTF-8 \
            LIBGL_ALWAYS_SOFTWARE=1 HOME="$work" TMPDIR="$work/tmp" BLENDER_USER_RESOURCES="$work/user" \
            XDG_CACHE_HOME="$work/cache" blender "$@"
        ;;
    *)
        die "scripts/blender_gui.sh tree SUITE | run SUITE WORK ARG…"
        ;;
esac
