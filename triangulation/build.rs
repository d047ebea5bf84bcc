//! For tests only, and not published: looks whether the data of the tests is there.

/// What is watched of the shared data. One file: a folder would be searched for changes by every build.
const SHARED: &str = "../../shared/data/FACTS.json";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // As in the root's build.rs: once the data has come, `touch` this file.
    println!("cargo::rustc-check-cfg=cfg(has_shared)");
    if std::path::Path::new(SHARED).exists() {
        println!("cargo::rustc-cfg=has_shared");
        println!("cargo::rerun-if-changed={SHARED}");
    }
}
