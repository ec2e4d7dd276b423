#!/usr/bin/env bash
# Makes and prints the folder of what outlives a run: environments, downloads, Blenders. It is curvefold in
# $XDG_CACHE_HOME, else in ~/.cache, and .cache/curvefold in the tree where neither can be written to.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
# Where HOME is not set, as in some services and containers, ~ is the home that the system knows for the user.
[ -n "${HOME:-}" ] || unset HOME
home=~

for base in "${XDG_CACHE_HOME:-}" "$home/.cache" "$root/.cache"; do
    folder="$base/curvefold"
    case "$base" in
        /*) mkdir -p "$folder" 2>/dev/null && [ -w "$folder" ] || continue ;;
        *) continue ;;
    esac
    printf '%s\n' "$folder"
    exit
done
echo "curvefold: no folder can be written to for environments and downloads; set XDG_CACHE_HOME" >&2
exit 1
