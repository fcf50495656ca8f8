/work/thr/models/target/release/deps/taut_models-b166fcb20a3ba31e.d: src/lib.rs src/../../crates/taut-delaunay/src/simplex.rs src/threads/../../../crates/taut-delaunay/src/threads/held.rs src/threads/../../../crates/taut-delaunay/src/threads/record.rs src/threads/../../../crates/taut-delaunay/src/threads/runs.rs src/threads/../../../crates/taut-delaunay/src/threads/slots.rs

/work/thr/models/target/release/deps/libtaut_models-b166fcb20a3ba31e.rlib: src/lib.rs src/../../crates/taut-delaunay/src/simplex.rs src/threads/../../../crates/taut-delaunay/src/threads/held.rs src/threads/../../../crates/taut-delaunay/src/threads/record.rs src/threads/../../../crates/taut-delaunay/src/threads/runs.rs src/threads/../../../crates/taut-delaunay/src/threads/slots.rs

/work/thr/models/target/release/deps/libtaut_models-b166fcb20a3ba31e.rmeta: src/lib.rs src/../../crates/taut-delaunay/src/simplex.rs src/threads/../../../crates/taut-delaunay/src/threads/held.rs src/threads/../../../crates/taut-delaunay/src/threads/record.rs src/threads/../../../crates/taut-delaunay/src/threads/runs.rs src/threads/../../../crates/taut-delaunay/src/threads/slots.rs

src/lib.rs:
src/../../crates/taut-delaunay/src/simplex.rs:
src/threads/../../../crates/taut-delaunay/src/threads/held.rs:
src/threads/../../../crates/taut-delaunay/src/threads/record.rs:
src/threads/../../../crates/taut-delaunay/src/threads/runs.rs:
src/threads/../../../crates/taut-delaunay/src/threads/slots.rs:
