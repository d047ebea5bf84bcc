//! Run files: a surface and its products, in the words of the command line.
//!
//! A file has a table `input` with the options of a surface, and a list `product` of tables, each
//! with a verb and its options. Options are not listed here again: each product becomes the words
//! of a single command, which the parser of the command line reads.

mod file;
mod nearest;
mod product_words;
mod refusal;
mod tree;
mod words;

pub(crate) use file::RunFile;
pub(crate) use product_words::ProductWords;
pub(crate) use refusal::refusal;
pub(crate) use words::{LIST, Vocabulary};
