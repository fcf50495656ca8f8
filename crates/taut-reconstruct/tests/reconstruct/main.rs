//! The tests of `taut-reconstruct` from outside, in one program: linking one for each file would take longer than running them.

mod test_length;

mod alpha_shapes;
mod clean_data;
mod clean_guarantees;
mod curve_bytes;
mod curve_certificates;
mod curve_fit;
mod curve_scenes;
mod curve_unseen;
mod samples;
mod surface_any;
mod surface_bytes;
mod surface_data;
mod surface_laws;
mod surface_noise;
mod surface_original;
mod surface_shapes;
mod thesis_data;
mod thesis_surface;
