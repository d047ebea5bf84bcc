//! Lines: constraints that may cross, are told apart, and are edited.

pub(super) mod build;
pub(super) mod constrain;
pub(super) mod corridor;
pub(super) mod edit;
pub(super) mod nesting;
pub(super) mod paths;
pub(super) mod simplify;
