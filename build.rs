//! Keeps statically linked SQLite and PROJ symbols private: otherwise a system libgdal in the
//! same process binds to ours and crashes. And looks whether the data of the tests is there.

use std::path::Path;

/// What is watched of the shared data. One file: a folder would be searched for changes by every build.
const SHARED: &str = "../shared/data/FACTS.json";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo::rustc-link-arg=-Wl,--exclude-libs,ALL");
    }
    // Tests that need the data are ignored without it. A file that is not there cannot be watched: every build would
    // start from the beginning. So once the data has come, `touch build.rs`.
    println!("cargo::rustc-check-cfg=cfg(has_shared)");
    if Path::new(SHARED).exists() {
        println!("cargo::rustc-cfg=has_shared");
        println!("cargo::rerun-if-changed={SHARED}");
    }
}
