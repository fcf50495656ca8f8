//! The tests of `taut-draw` from outside, in one program: linking one for each file would take longer than running them.

mod centers;
mod classifiers;
mod curve;
mod delaunay;
mod ellipsoids;
mod figures;
mod gaps;
mod inscribed;
mod robust;
mod surface;
#[cfg(feature = "png")]
mod test_length;
mod viewer;
