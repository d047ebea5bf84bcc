//! The tables of lines in a form to be saved.

use crate::line_id::LineId;
use crate::tds::VertexId;

use super::chains::Chains;
use super::on_crossing::Rounding;
use super::tables::Lines;

/// The content of [`Lines`], in an order that depends on nothing else.
pub(crate) struct SavedTables {
    /// The vertices by which each line was given, by line id; `None` for a removed line.
    pub(crate) given: Vec<Option<Vec<VertexId>>>,
    /// The sites of bent segments, from the smaller end to the larger, ends included.
    pub(crate) bent: Vec<Vec<VertexId>>,
    /// Edges of chains that were split: the smaller end, the larger end, and the vertex between.
    pub(crate) splits: Vec<[VertexId; 3]>,
    pub(crate) waiting: Vec<[VertexId; 2]>,
    pub(crate) added: Vec<VertexId>,
    /// The owned vertices, in order.
    pub(crate) owned: Vec<VertexId>,
    pub(crate) rounding: Option<Rounding>,
    pub(crate) recrossed: bool,
}

impl Lines {
    /// Returns a copy of the content.
    pub(crate) fn saved_tables(&self) -> SavedTables {
        let segments = self.chains.segments();
        let mut splits: Vec<[VertexId; 3]> = self
            .chains
            .splits
            .iter()
            .map(|(&[a, b], &between)| [a, b, between])
            .collect();
        splits.sort_unstable();
        let bent = segments
            .iter()
            .filter(|ends| self.chains.bent.contains_key(*ends));
        SavedTables {
            given: self
                .chains
                .given
                .iter()
                .map(|line| line.as_deref().map(<[_]>::to_vec))
                .collect(),
            bent: bent.map(|&ends| self.chains.sites(ends)).collect(),
            splits,
            waiting: self.waiting.clone(),
            added: self.added.iter().collect(),
            owned: self.owned.iter().collect(),
            rounding: self.rounding,
            recrossed: self.recrossed,
        }
    }

    /// Returns lines with this content, which must still be [checked](Self::check).
    ///
    /// # Errors
    /// If the content does not fit into the tables; the error says why.
    pub(crate) fn from_saved_tables(tables: SavedTables) -> Result<Self, &'static str> {
        if tables.given.len() >= LineId::LIMIT {
            return Err("there are too many lines");
        }
        let given = tables
            .given
            .into_iter()
            .map(|line| line.map(|vertices| vertices[..].into()));
        let mut chains = Chains {
            given: given.collect(),
            ..Chains::default()
        };
        for chain in tables.bent {
            let is_new = match chain[..] {
                [a, ref between @ .., b] => {
                    a < b && chains.bent.insert([a, b], between.into()).is_none()
                }
                _ => false,
            };
            is_new
                .then_some(())
                .ok_or("a segment has two chains, or is turned around")?;
        }
        for [a, b, between] in tables.splits {
            let is_new = a < b && chains.splits.insert([a, b], between).is_none();
            is_new
                .then_some(())
                .ok_or("an edge is split twice, or is turned around")?;
        }
        if tables.waiting.iter().any(|[a, b]| a == b) {
            return Err("a constraint has one end");
        }
        Ok(Lines {
            chains,
            waiting: tables.waiting,
            added: tables.added.into_iter().collect(),
            owned: tables.owned.into_iter().collect(),
            rounding: tables.rounding,
            recrossed: tables.recrossed,
            has_stray_edges: true, // it may be a refined mesh
            ..Lines::default()
        })
    }
}
