//! Classifiers: laws that hold for any data, models as files, and public data where `TAUT_DATA` names a folder with it.

mod clusters;
mod laws;
mod models;
mod public_data;
mod rejection;
mod support;
