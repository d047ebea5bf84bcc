#!/bin/bash
# Time against size: the first points of one large file, from a thousand to all of them, for breakline and other programs.
#
#   benches/scaling.sh [-r RUNS] [-t "THREADS ..."] [-p NAME=PROGRAM ...] FILE.xy > scaling.txt
#   benches/plot_scaling.py < scaling.txt > scaling.svg
#
# The points of the file have to be in random order, so that the first of them are spread like all. Each line that is
# printed is the run of median time, in the form of triangulation/examples/bench_triangulation.rs. PROGRAM: see against_peers.sh.
set -euo pipefail
runs=3
. "$(dirname "$0")/common.sh"
part=$(mktemp --suffix .xy)
trap 'rm -f "$part"' EXIT

median() { # of the lines of RUNS runs, that of the median time
    for _ in $(seq "$runs"); do "$@" 2>/dev/null | tail -1; done | sort -g -k 5,5 | sed -n "$(((runs + 1) / 2))p"
}

all=$(($(stat -c %s "$1") / 16))
for count in 1000 10000 100000 1000000 10000000 100000000; do
    [ "$count" -le "$all" ] || break
    head -c $((16 * count)) "$1" > "$part"
    for number in $threads; do median "$ours" "$part" --threads "$number"; done
    for peer in "${peers[@]}"; do median "${peer#*=}" "${peer%%=*}" "$part" || true; done
done
