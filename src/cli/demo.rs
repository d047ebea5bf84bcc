use super::Exit;
use super::args::DemoArgs;
use super::talk::Talk;
use crate::error::Result;

pub(super) fn run(_args: &DemoArgs, _talk: &Talk) -> Result<Exit> {
    Ok(Exit::Done)
}
