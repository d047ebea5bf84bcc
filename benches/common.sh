# Sourced by the comparisons with other programs, with the default of `runs` set: their options, and `ours`, the program
# of this repository. `takes` names the options that only one of them has, for getopts.
threads="1 2" folder=. peers=()
while getopts "r:t:p:${takes:-}" option; do
    case $option in
        r) runs=$OPTARG ;;
        t) threads=$OPTARG ;;
        d) folder=$OPTARG ;;
        p) peers+=("$OPTARG") ;;
        *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cargo build --release --quiet --manifest-path "$root/Cargo.toml" -p breakline-triangulation --features bench,parallel --example bench_triangulation
ours=${CARGO_TARGET_DIR:-$root/target}/release/examples/bench_triangulation
