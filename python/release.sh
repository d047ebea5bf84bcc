#!/bin/bash
# Builds wheels of the Python package into a folder, one for each platform:
#
#     python/release.sh dist                     # all platforms that this system can build for
#     python/release.sh dist x86_64-unknown-linux-gnu
#
# One wheel per platform serves Python 3.9 and later (stable ABI). On Linux, maturin with zig builds for other processors
# and for musl (`pip install maturin[zig]`), and with cargo-xwin for Windows; wheels for macOS are built on macOS. The
# platforms are those of https://www.maturin.rs/platform_support. Nothing is uploaded.
set -euo pipefail
cd "$(dirname "$0")"
dist=${1:?folder for the wheels}
shift
case "$(uname -s)" in
    Darwin) all=(universal2-apple-darwin) ;;
    *) all=(x86_64-unknown-linux-gnu aarch64-unknown-linux-gnu x86_64-unknown-linux-musl aarch64-unknown-linux-musl
        x86_64-pc-windows-msvc) ;;
esac
[ $# -gt 0 ] || set -- "${all[@]}"
for target; do
    rustup target add "${target/universal2/aarch64}"
    case "$target" in
        universal2-*) rustup target add x86_64-apple-darwin ;;
    esac
    case "$target" in
        *-linux-gnu) options=(--zig --compatibility manylinux2014) ;;
        *-linux-musl) options=(--zig --compatibility musllinux_1_2) ;;
        *) options=() ;;
    esac
    maturin build --release --locked --strip --target "$target" "${options[@]}" --out "$dist"
done
ls -l "$dist"
