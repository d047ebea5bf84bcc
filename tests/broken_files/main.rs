//! Files that are cut, changed or ambiguous: an error or a warning, and never a product that is
//! silently smaller. `docs/formats.md`, "Damaged files", is the table that `cut.rs` holds readers
//! to.
//!
//! | variable | sets the number of |
//! |---|---|
//! | `BREAKLINE_TEXTS` | random texts |
//! | `BREAKLINE_MESHES` | random meshes |
//! | `BREAKLINE_FLIPS` | changed bytes of each format |

mod cut;
mod flaws;
mod texts;

/// The number of cases that a variable asks for, else a few.
fn cases(variable: &str, few: usize) -> usize {
    std::env::var(variable)
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(few)
}
