//! The tests of `taut-certify` from outside, in one program: linking one for each file would take longer than running them.

mod test_length;

mod ball_closed_forms;
mod ball_mutations;
mod ball_properties;
mod ball_refusals;
mod ball_threads;
mod centers_ellipsoids;
mod centers_mutations;
mod centers_properties;
mod centers_refusals;
mod common;
mod curve_doubts;
mod curve_mutations;
mod curve_trials;
mod ellipsoid_closed_forms;
mod ellipsoid_json;
mod ellipsoid_mutations;
mod ellipsoid_properties;
mod ellipsoid_refusals;
mod ellipsoid_shapes;
mod files_bytes;
mod json;
mod mesh;
mod shape_indefinite;
mod surface;
mod surface_crossings;
mod surface_doubts;
mod surface_mutations;
mod surface_properties;
mod surface_shapes;
mod triangulation;
mod triangulation_mutations;
