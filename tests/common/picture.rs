//! A picture of what a test was about when it failed.

use std::path::Path;

/// Draws and says where, if the test fails while this is there.
pub(crate) struct OnFailure<F: Fn() -> String> {
    /// Of the file.
    pub(crate) name: &'static str,
    pub(crate) svg: F,
}

impl<F: Fn() -> String> Drop for OnFailure<F> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(self.name).with_extension("svg");
            match std::fs::write(&path, (self.svg)()) {
                Ok(()) => eprintln!("see {}", path.display()),
                Err(error) => eprintln!("no picture: {error}"),
            }
        }
    }
}
