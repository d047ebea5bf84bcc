//! Two classifications of the same points as lines and as JSON.

use serde_json::{Value, json};

use super::statistics::shown;
use crate::data::classes::name;
use crate::run::ClassComparison;

/// Returns the lines, with the most frequent differences first.
pub(crate) fn text(found: &ClassComparison) -> String {
    let ground = found.ground();
    let share = |title: &str, value: f64| format!("{title:<12} {:>16} %", shown(100.0 * value));
    let mut lines = vec![
        format!("{:<12} {:>16}", "points", found.points()),
        format!("{:<12} {:>16}", "changed", found.changed()),
        share("type I", ground.lost),
        share("type II", ground.kept),
        share("total", ground.total),
        share("kappa", ground.kappa),
    ];
    let mut pairs: Vec<_> = found.pairs.iter().collect();
    pairs.retain(|([first, second], _)| first != second);
    pairs.sort_by_key(|(pair, count)| (std::cmp::Reverse(**count), **pair));
    lines.extend(pairs.into_iter().map(|([first, second], count)| {
        let [of_first, of_second] = [first, second].map(|class| name(usize::from(*class)));
        format!("{count:>29} {first} ({of_first}), and {second} ({of_second}) in the second")
    }));
    lines.join("\n") + "\n"
}

/// Returns the exact counts, and the shares of the ground.
pub(crate) fn json(found: &ClassComparison) -> Value {
    let ground = found.ground();
    let pairs = found.pairs.iter();
    let pairs = pairs
        .map(|([first, second], count)| json!({"first": first, "second": second, "points": count}));
    json!({
        "points": found.points(),
        "changed": found.changed(),
        "ground": {
            "type_1": ground.lost,
            "type_2": ground.kept,
            "total": ground.total,
            "kappa": ground.kappa,
        },
        "pairs": pairs.collect::<Vec<_>>(),
    })
}
