//! The Rust in the pages for people, compiled and run with the tests.
//!
//! This crate is not published: the packages of the others come without the pages.
#![forbid(unsafe_code)]

#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../docs/ball.md")]
    struct Ball;
    #[doc = include_str!("../../../docs/bodies.md")]
    struct Bodies;
    #[doc = include_str!("../../../docs/centers.md")]
    struct Centers;
    #[doc = include_str!("../../../docs/circle.md")]
    struct Circle;
    #[doc = include_str!("../../../docs/classify.md")]
    struct Classify;
    #[doc = include_str!("../../../docs/compare.md")]
    struct Compare;
    #[doc = include_str!("../../../docs/curve.md")]
    struct Curve;
    #[doc = include_str!("../../../docs/delaunay.md")]
    struct Delaunay;
    #[doc = include_str!("../../../docs/dop.md")]
    struct Dop;
    #[doc = include_str!("../../../docs/ellipse.md")]
    struct Ellipse;
    #[doc = include_str!("../../../docs/ellipsoid.md")]
    struct Ellipsoid;
    #[doc = include_str!("../../../docs/hands.md")]
    struct Hands;
    #[doc = include_str!("../../../docs/kernel-ball.md")]
    struct KernelBall;
    #[doc = include_str!("../../../docs/memory.md")]
    struct Memory;
    #[doc = include_str!("../../../docs/polygon.md")]
    struct Polygon;
    #[doc = include_str!("../../../docs/rectangle.md")]
    struct Rectangle;
    #[doc = include_str!("../../../docs/robust.md")]
    struct Robust;
    #[doc = include_str!("../../../docs/sphere-tree.md")]
    struct SphereTree;
    #[doc = include_str!("../../../docs/surface.md")]
    struct Surface;
    #[doc = include_str!("../../../docs/terrain.md")]
    struct Terrain;
    #[doc = include_str!("../../../docs/triangle.md")]
    struct Triangle;
    #[doc = include_str!("../../../docs/memory/figures.md")]
    struct Figures;
    #[doc = include_str!("../../../docs/memory/matrix.md")]
    struct Matrix;
    #[doc = include_str!("../../../docs/memory/order.md")]
    struct Order;
    #[doc = include_str!("../../../docs/memory/packed.md")]
    struct Packed;
    #[doc = include_str!("../../../docs/memory/queue.md")]
    struct Queue;
    #[doc = include_str!("../../../docs/memory/sample.md")]
    struct Sample;
    #[doc = include_str!("../../../docs/memory/search.md")]
    struct Search;
    #[doc = include_str!("../../../docs/memory/simulate.md")]
    struct Simulate;
    #[doc = include_str!("../../../docs/memory/sort.md")]
    struct Sort;
    #[doc = include_str!("../../taut/README.md")]
    struct ReadmeOfTaut;
    #[doc = include_str!("../../taut-delaunay/README.md")]
    struct ReadmeOfTautDelaunay;
    #[doc = include_str!("../../taut-inscribe/README.md")]
    struct ReadmeOfTautInscribe;
    #[doc = include_str!("../../taut-io/README.md")]
    struct ReadmeOfTautIo;
    #[doc = include_str!("../../taut-oblivious/README.md")]
    struct ReadmeOfTautOblivious;
    #[doc = include_str!("../../taut-points/README.md")]
    struct ReadmeOfTautPoints;
    #[doc = include_str!("../../taut-predicates/README.md")]
    struct ReadmeOfTautPredicates;
    #[doc = include_str!("../../taut-search/README.md")]
    struct ReadmeOfTautSearch;
}
