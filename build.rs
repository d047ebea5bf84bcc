//! Keeps statically linked SQLite and PROJ symbols private: otherwise a system libgdal in the
//! same process binds to ours and crashes.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        println!("cargo:rustc-link-arg=-Wl,--exclude-libs,ALL");
    }
}
