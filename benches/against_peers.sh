#!/bin/bash
# Breakline and other programs in turn on the same files: medians, and how many times as long as breakline they take.
#
#   benches/against_peers.sh [-r RUNS] [-t "THREADS ..."] [-d FOLDER] [-p NAME=PROGRAM ...] DATA ...
#
# DATA is the stem of FOLDER/DATA.xy (or .xyz); DATA+seg takes FOLDER/DATA.seg, too. A PROGRAM is called as
# `PROGRAM NAME FILE [FILE.seg]` and prints, like triangulation/examples/bench_triangulation.rs:
#   name data points threads seconds peak_MB growth_MB triangles processor_seconds
# What fails on some data is left out there. Runs are interleaved, so that a busy minute hits all alike.
set -euo pipefail
runs=5 takes=d:
. "$(dirname "$0")/common.sh"

printf '%-14s %-22s %7s %9s %8s %9s %8s\n' data program threads seconds ns/point B/point ratio
for data in "$@"; do
    stem=${data%+seg}
    file=$folder/$stem.xy
    [ -e "$file" ] || file=$folder/$stem.xyz
    files=("$file")
    [ "$stem" = "$data" ] || files+=("$folder/$stem.seg")
    for _ in $(seq "$runs"); do
        for count in $threads; do "$ours" "${files[@]}" --threads "$count"; done
        for peer in "${peers[@]}"; do "${peer#*=}" "${peer%%=*}" "${files[@]}" 2>/dev/null | tail -1 || true; done
    done | awk -v data="$data" '
        NF >= 9 { key = $1 " " $4; if (!(key in runs)) order[++keys] = key; runs[key]++; points = $3
                  seconds[key, runs[key]] = $5; growth[key, runs[key]] = $7 }
        function median(of, key,    i, j, t, list) {
            for (i = 1; i <= runs[key]; i++) list[i] = of[key, i]
            for (i = 2; i <= runs[key]; i++) for (j = i; j > 1 && list[j] < list[j - 1]; j--) { t = list[j]; list[j] = list[j - 1]; list[j - 1] = t }
            return (list[int((runs[key] + 1) / 2)] + list[int(runs[key] / 2) + 1]) / 2
        }
        END { for (k = 1; k <= keys; k++) {
                  key = order[k]; split(key, name, " "); s = median(seconds, key)
                  if (k == 1) first = s
                  printf "%-14s %-22s %7d %9.4f %8.1f %9.1f %8.2f\n", data, name[1], name[2], s, s * 1e9 / points, median(growth, key) * 1048576 / points, s / first } }'
done
