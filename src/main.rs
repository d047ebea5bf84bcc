//! The `breakline` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    #[cfg(unix)]
    signals::clean_up();
    hold_back_contained_panics();
    breakline::cli::run(std::env::args_os()).into()
}

/// Installs a panic hook that prints nothing for a decoder's panic that is caught and becomes an
/// error.
fn hold_back_contained_panics() {
    let print = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !breakline::io::is_contained() {
            print(panic);
        }
    }));
}

/// Removal of temporary files when a signal ends the program.
#[cfg(unix)]
mod signals {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::emulate_default_handler;
    use std::sync::Arc;
    use std::time::{Duration, Instant};

    /// A signal that comes so long after the first one ends the program at once.
    const IMPATIENT: Duration = Duration::from_secs(1);

    /// Handles SIGINT, SIGTERM, SIGQUIT and SIGHUP: removes temporary files, then ends the process
    /// as the signal would have done. A shell sees the status 128 + the signal's number, and a loop
    /// in a script ends, too. A second signal, a second later, ends it without waiting.
    pub(super) fn clean_up() {
        // Ignored, so that a file beyond the user's size limit is an error like a full disk.
        let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
        let heeded = [SIGINT, SIGTERM, SIGQUIT, SIGHUP]
            .into_iter()
            .filter(|&signal| !is_ignored(signal));
        // If this fails, the worst is that temporary files stay.
        let Ok(mut signals) = Signals::new(heeded) else {
            return;
        };
        std::thread::spawn(move || {
            let mut signals = signals.forever();
            let Some(signal) = signals.next() else {
                return;
            };
            let begin = Instant::now();
            std::thread::spawn(move || {
                let _nothing_appears_now = breakline::io::abandon_outputs();
                breakline::cli::print_last_words();
                end(signal);
            });
            // Many files take a while. Shells and parents may send two signals at once.
            if let Some(signal) = signals.find(|_| begin.elapsed() > IMPATIENT) {
                end(signal);
            }
        });
    }

    fn end(signal: i32) -> ! {
        // The first process of a container is not ended by signals.
        if std::process::id() != 1 {
            let _ = emulate_default_handler(signal);
        }
        std::process::exit(128 + signal);
    }

    /// Returns true if the parent process had ignored the signal, as `nohup` does; false if the
    /// system does not say.
    fn is_ignored(signal: i32) -> bool {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
    }
}
