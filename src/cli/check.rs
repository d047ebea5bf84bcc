use super::args::CheckArgs;
use super::plan::SurfacePlan;
use super::summary::SurfaceFacts;
use super::talk::Talk;
use super::{Exit, gather, open, print};
use crate::error::Result;

/// Lists the flaws of a TIN.
pub(super) fn run(args: &CheckArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let gathered = gather::surface(&mut plan, talk)?;
    let surface = gathered.surface.as_ref();
    let flaws = open::flaws(surface);
    for flaw in &flaws {
        print(&format!("{flaw}\n"))?;
    }
    gathered.made.tell(surface, talk);
    let SurfaceFacts { vertices, triangles, constrained, .. } = SurfaceFacts::of(surface);
    let what = format!("{vertices} vertices, {triangles} triangles, {constrained} constrained edges");
    match flaws.len() {
        0 => {
            print(&format!("{what}: no flaw found\n"))?;
            Ok(Exit::Done)
        }
        count => {
            print(&format!("{what}: {count} flaws\n"))?;
            Ok(Exit::Failed)
        }
    }
}
