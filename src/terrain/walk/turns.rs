//! Several lines that are followed in turns.

use super::follow::Follow;
use super::ground::Ground;
use super::segment::Segment;
use super::step::{At, Exit, Steps};
use super::stretches::Stretches;
use crate::data::{FaceAcross, Stretch};
use crate::error::{Error, Result};

/// How many lines take turns.
///
/// `PERF:` memory answers within the time that this many crossings take.
const AT_ONCE: usize = 8;

/// Returns the parts of each line that are on a surface.
///
/// # Errors
/// If a coordinate is not finite, the faces overlap, or the surface was found damaged.
pub(super) fn in_turns(ground: &Ground<'_>, lines: &[&[[f64; 2]]]) -> Result<Vec<Vec<Stretch>>> {
    let mut found = vec![Vec::new(); lines.len()];
    let mut waiting = lines.iter().enumerate();
    let mut walks: Vec<Walk<'_>> = Vec::with_capacity(AT_ONCE.min(lines.len()));
    loop {
        while walks.len() < AT_ONCE
            && let Some((number, line)) = waiting.next()
        {
            let mut walk = Walk::new(ground, number, line)?;
            walk.next_edge(ground)?;
            walks.push(walk);
        }
        if walks.is_empty() {
            ground.surface.ensure_intact()?;
            return Ok(found);
        }
        // `PERF:` all are asked for first, so that memory answers for several lines at a time.
        for walk in &mut walks {
            walk.across = walk.exit.and_then(|exit| walk.steps.across(&exit));
        }
        let mut i = 0;
        while let Some(walk) = walks.get_mut(i) {
            if walk.exit.is_some() {
                walk.cross(ground)?;
                i += 1;
            } else {
                let ended = walks.swap_remove(i);
                found[ended.number] = ended.found.end();
            }
        }
    }
}

/// A line that is followed.
struct Walk<'a> {
    /// Its number among all lines.
    number: usize,
    /// Its vertices from the start of the segment on.
    rest: &'a [[f64; 2]],
    /// Where the segment before has ended; `None` before the first one.
    at: Option<At>,
    steps: Steps<'a>,
    /// The segment, once it has begun.
    follow: Option<Follow>,
    /// The edge that comes next; `None` at the end of the line.
    exit: Option<Exit>,
    /// The face beyond that edge, once it was asked for.
    across: Option<FaceAcross>,
    found: Stretches,
}

impl<'a> Walk<'a> {
    fn new(ground: &Ground<'a>, number: usize, line: &'a [[f64; 2]]) -> Result<Self> {
        if let Some(vertex) = line.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
            let [x, y] = line[vertex];
            let number = vertex + 1;
            return Err(Error::usage(format!(
                "vertex {number} of the line at {x} {y}: expected finite coordinates"
            )));
        }
        Ok(Walk {
            number,
            rest: line,
            at: None,
            steps: Steps::new(ground.surface),
            follow: None,
            exit: None,
            across: None,
            found: Stretches::default(),
        })
    }

    /// Goes over the edge, and on to the next one.
    #[inline]
    fn cross(&mut self, ground: &Ground<'a>) -> Result<()> {
        if let (Some(follow), Some(exit)) = (&mut self.follow, &mut self.exit) {
            let mut take = |point| self.found.take(point);
            match follow.cross(exit, self.across.as_ref(), &mut self.steps, &mut take) {
                Ok(true) => return Ok(()),
                Ok(false) => {}
                Err(at) => self.end_segment(at, ground)?,
            }
        }
        self.next_edge(ground)
    }

    /// Goes on to the next edge that the line crosses, or to its end.
    fn next_edge(&mut self, ground: &Ground<'a>) -> Result<()> {
        loop {
            let mut take = |point| self.found.take(point);
            if let Some(follow) = &mut self.follow {
                match follow.next_edge(&mut self.steps, &ground.rim, &mut take) {
                    Ok(exit) => {
                        self.exit = Some(exit);
                        return Ok(());
                    }
                    Err(at) => self.end_segment(at, ground)?,
                }
            }
            let [from, to, ..] = *self.rest else {
                self.exit = None;
                return Ok(());
            };
            let Some(segment) = Segment::new(from, to) else {
                self.rest = &self.rest[1..];
                continue;
            };
            self.steps = Steps::new(ground.surface);
            let start = match self.at {
                Some(at) => at,
                None => ground.locate(from, &mut self.steps),
            };
            self.found.begin(&segment);
            let mut take = |point| self.found.take(point);
            self.follow = Some(Follow::new(&mut self.steps, segment, start, &mut take));
        }
    }

    /// Ends a segment where it has come to.
    fn end_segment(&mut self, at: At, ground: &Ground<'_>) -> Result<()> {
        if self.steps.are_endless() {
            ground.surface.ensure_intact()?;
            let [x, y] = self.rest[0];
            return Err(Error::format(format!("the faces near {x} {y} overlap"))
                .cure("a surface has one height at each position: repair it"));
        }
        self.at = Some(at);
        self.follow = None;
        self.rest = &self.rest[1..];
        Ok(())
    }
}
