//! Tests of the plane: kinds, location, edits, queries, meshes, files. A single program, so that
//! the triangulations that all of these tests use are compiled once.

mod around;
mod boxes;
mod center;
mod chosen;
mod compact;
mod dual;
mod grid;
mod kernels;
mod kinds;
mod location;
mod mapped;
mod natural;
mod nowhere;
mod payloads;
mod points_among_lines;
mod polygon;
mod power;
mod queries;
mod refine;
mod regular;
mod removal;
mod sequences;
mod traversal;
