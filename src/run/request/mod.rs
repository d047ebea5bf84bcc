//! What is asked of a verb, where several verbs have it in common.

pub(crate) mod input;
pub(crate) mod lines;
pub(crate) mod serialized;
pub(crate) mod sizes;
