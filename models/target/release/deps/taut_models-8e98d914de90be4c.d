/work/thr/models/target/release/deps/taut_models-8e98d914de90be4c.d: src/lib.rs src/../../crates/taut-delaunay/src/simplex.rs src/threads/../../../crates/taut-delaunay/src/threads/held.rs src/threads/../../../crates/taut-delaunay/src/threads/record.rs src/threads/../../../crates/taut-delaunay/src/threads/runs.rs src/threads/../../../crates/taut-delaunay/src/threads/slots.rs src/threads/models.rs

/work/thr/models/target/release/deps/taut_models-8e98d914de90be4c: src/lib.rs src/../../crates/taut-delaunay/src/simplex.rs src/threads/../../../crates/taut-delaunay/src/threads/held.rs src/threads/../../../crates/taut-delaunay/src/threads/record.rs src/threads/../../../crates/taut-delaunay/src/threads/runs.rs src/threads/../../../crates/taut-delaunay/src/threads/slots.rs src/threads/models.rs

src/lib.rs:
src/../../crates/taut-delaunay/src/simplex.rs:
src/threads/../../../crates/taut-delaunay/src/threads/held.rs:
src/threads/../../../crates/taut-delaunay/src/threads/record.rs:
src/threads/../../../crates/taut-delaunay/src/threads/runs.rs:
src/threads/../../../crates/taut-delaunay/src/threads/slots.rs:
src/threads/models.rs:
