//! The command line, through the real binary: what goes in, what comes out, and how it ends.

mod bad_input;
mod ball;
mod ball_kernel;
mod centers;
mod classify;
mod curve;
mod delaunay;
mod delaunay_terrain;
mod delaunay_tiles;
mod dop;
mod ellipsoid;
mod generate;
mod hand;
#[cfg(feature = "store")]
mod hand_people;
mod inscribe;
mod inscribe_bodies;
mod inscribe_circle;
mod inscribe_dops;
mod inscribe_ellipse;
mod inscribe_exports;
mod inscribe_options;
mod inscribe_polygon;
mod inscribe_rectangle;
mod inscribe_triangle;
#[cfg(unix)]
mod interrupt;
mod limits;
mod memory;
mod meshes;
mod near;
mod other_programs;
mod outputs;
mod pages;
mod pictures;
mod places;
mod robust;
#[cfg(unix)]
mod screens;
mod shapes;
mod stream;
mod surface;
mod tables;
mod test_folder;
mod test_length;
mod threads;
mod usps;
mod verify;
mod words;
