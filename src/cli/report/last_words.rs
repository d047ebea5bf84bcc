//! What is printed if a signal ends the program: how to go on.

use std::io::Write;
use std::sync::{Mutex, PoisonError};

use super::escape;

/// The line that is printed, while there is one.
static WORDS: Mutex<Option<String>> = Mutex::new(None);

/// A line that is printed if a signal ends the program while this lives.
#[derive(Debug)]
pub(crate) struct LastWords(());

impl LastWords {
    pub(super) fn new(text: String) -> Self {
        *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = Some(text);
        LastWords(())
    }
}

impl Drop for LastWords {
    fn drop(&mut self) {
        *WORDS.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// Prints how to go on, if there is something to go on with. A closed stderr is ignored.
pub(crate) fn print() {
    if let Some(text) = WORDS.lock().unwrap_or_else(PoisonError::into_inner).take() {
        let _ = writeln!(std::io::stderr(), "{}", escape::line(&text));
    }
}
