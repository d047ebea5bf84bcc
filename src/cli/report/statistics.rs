//! What statistics of differences are called in tables.

use crate::run::units::number;

/// The titles of [`ErrorStatistics::values`](crate::terrain::ErrorStatistics::values).
pub(super) const TITLES: [&str; 9] = [
    "mean", "median", "std dev", "RMSE", "NMAD", "95 %", "min", "max", "skew",
];

/// Returns a rounded number, without a sign if it is 0; a dash if there is none.
pub(super) fn shown(value: f64) -> String {
    match value.is_nan() {
        true => "-".to_owned(),
        false => number(value + 0.0),
    }
}
