//! Triangulations in space.

mod along;
mod alpha;
mod bulk;
mod bulk_regular;
mod compact;
mod dual;
mod facts;
mod gabriel;
mod hull;
mod location;
mod natural;
mod queries;
mod regular;
mod removal;
mod sequences;
mod within_box;
mod zones;
