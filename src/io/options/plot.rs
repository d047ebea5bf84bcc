//! How profiles are drawn.

/// How profiles are drawn. By default, as wide as the longest one is, with heights exaggerated so
/// that they can be seen.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlotOptions {
    /// By how much heights are drawn larger than distances.
    pub exaggeration: Option<f64>,
    /// The height at which each plot begins; a round height below the lowest point if it is `None`.
    pub datum: Option<f64>,
    /// A title above all plots.
    pub title: Option<String>,
}
