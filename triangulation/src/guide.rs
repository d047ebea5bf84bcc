//! Guides for those who know another package: their calls and ours side by side, with an example
//! that runs.

#[doc = include_str!("../docs/from-cgal.md")]
pub mod from_cgal {}

#[doc = include_str!("../docs/from-spade.md")]
pub mod from_spade {}

#[doc = include_str!("../docs/from-triangle.md")]
pub mod from_triangle {}
