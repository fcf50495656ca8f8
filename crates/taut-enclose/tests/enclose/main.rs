//! The tests of `taut-enclose` from outside, in one program: linking one for each file would take longer than running them.

#[path = "../../../test_length.rs"]
mod test_length;

mod ball_bytes;
mod ball_degenerate;
mod ball_of_balls;
mod ball_of_ellipsoids;
mod ball_properties;
mod ball_sources;
mod ball_thesis;
mod centers;
mod centers_bytes;
mod centers_damage;
mod centers_exact;
mod centers_groups;
mod centers_laws;
mod centers_numbers;
mod centers_outliers;
mod centers_threads;
mod certificate_edits;
mod circles;
mod common;
mod covering;
mod ellipse_support;
mod ellipsoid_batch;
mod ellipsoid_bytes;
mod ellipsoid_closed_forms;
mod ellipsoid_degenerate;
mod ellipsoid_of_ellipsoids;
mod ellipsoid_properties;
mod ellipsoid_sources;
mod ellipsoid_thesis;
mod ellipsoid_thin;
mod ellipsoids;
mod farthest_first;
mod inscribed_ellipsoid;
mod kernel_ball;
mod robust;
mod robust_far;
mod robust_mcd;
mod robust_mutations;
mod robust_odd_sets;
mod robust_volume;
mod shapes;
mod sphere_tree;
mod streaming;
