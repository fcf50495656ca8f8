//! The tests of `taut-inscribe` from outside, in one program.

mod test_length;

mod any_bytes;
mod bad_polygons;
mod bodies;
mod closed_forms;
mod common;
mod countries;
mod degenerate;
mod ellipse_mutations;
mod ellipses;
mod extreme_scales;
mod laws;
mod mutations;
mod oriented_rectangles;
mod polygons;
mod rectangles;
mod rings;
mod sampling;
mod thesis_methods;
mod triangle_mutations;
mod triangles;
