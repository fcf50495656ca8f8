//! taut beside its peers.
fn main() {}
