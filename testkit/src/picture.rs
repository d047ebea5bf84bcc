//! Pictures of the input of a failed test.

/// Draws a picture and prints its path, if the test fails while this is alive.
pub struct OnFailure<F: Fn() -> String> {
    /// The name of the file.
    pub name: &'static str,
    pub svg: F,
}

impl<F: Fn() -> String> Drop for OnFailure<F> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let path = std::env::temp_dir().join(self.name).with_extension("svg");
            match std::fs::write(&path, (self.svg)()) {
                Ok(()) => eprintln!("see {}", path.display()),
                Err(error) => eprintln!("no picture: {error}"),
            }
        }
    }
}
