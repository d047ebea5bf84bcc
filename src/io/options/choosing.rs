//! Records that a condition chooses, while a layer is read.

use super::condition::{BoundCondition, RECORDS_AT_ONCE};
use super::layer::Options;
use crate::data::Layer;
use crate::error::{Error, Result};

/// Removes the records of a layer for which the condition does not hold, as they are read.
pub(crate) struct Choosing<'a> {
    condition: Option<BoundCondition<'a>>,
    /// The records for which the condition was evaluated.
    seen: usize,
}

impl<'a> Options<'a> {
    /// Returns what chooses the records of a layer, whose attributes are known.
    ///
    /// # Errors
    /// If the layer lacks an attribute of the condition, or the format has none that are read.
    pub(crate) fn choosing(&self, layer: &Layer) -> Result<Choosing<'a>> {
        let Some(condition) = self.condition else {
            return Ok(Choosing {
                condition: None,
                seen: 0,
            });
        };
        let Some(attributes) = &layer.attributes else {
            return Err(Error::unsupported(format!(
                "{} has no attributes that are read, which `{}` needs",
                layer.format,
                condition.text()
            )));
        };
        Ok(Choosing {
            condition: Some(condition.bind(&attributes.names)?),
            seen: 0,
        })
    }
}

impl Choosing<'_> {
    /// Evaluates the condition for the records that were added to a layer since the last call, if
    /// these are many. To be called after each record.
    ///
    /// # Errors
    /// That of [`BoundCondition::holds`], with the number of the record.
    #[inline]
    pub(crate) fn added(&mut self, layer: &mut Layer) -> Result<()> {
        match self.condition {
            Some(_) if layer.shapes.len() - chosen(layer) >= RECORDS_AT_ONCE => self.choose(layer),
            _ => Ok(()),
        }
    }

    /// Evaluates the condition for the last records of a layer. If none is left of all, there is a
    /// warning.
    ///
    /// # Errors
    /// That of [`added`](Self::added).
    pub(crate) fn finish(mut self, layer: &mut Layer) -> Result<()> {
        self.choose(layer)?;
        if let Some(condition) = self.condition
            && layer.shapes.is_empty()
            && self.seen > 0
        {
            let text = condition.text();
            let none = format!("none of {} records is true for `{text}`", self.seen);
            layer.warnings.push(none.into());
        }
        Ok(())
    }

    fn choose(&mut self, layer: &mut Layer) -> Result<()> {
        let Some(condition) = &self.condition else {
            return Ok(());
        };
        let first = chosen(layer);
        let held = (first..layer.shapes.len()).map(|at| {
            let rows = layer.attributes.as_ref().map(|found| &found.rows);
            let row = rows.and_then(|rows| rows.get(at));
            let record = self.seen + at - first + 1;
            let holds = condition.holds(row.map_or(&[], Vec::as_slice));
            holds.map_err(|e| e.at(format!("record {record}")))
        });
        let held: Vec<bool> = held.collect::<Result<_>>()?;
        layer.keep(self.seen, &held);
        self.seen += held.len();
        Ok(())
    }
}

/// Returns how many shapes of a layer are chosen already. For those after them, the condition was
/// not evaluated yet.
fn chosen(layer: &Layer) -> usize {
    layer.chosen.as_ref().map_or(0, Vec::len)
}
