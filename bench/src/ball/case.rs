//! The list of cases.

use super::*;

/// What is done in a section.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// Generated points, solved exactly.
    Points(PointsCase),
    /// The USPS digits.
    Usps,
    /// Balls under several radius laws.
    Balls(BallsCase),
    /// A file of 10 GB.
    File,
    /// Core-set sizes with one far point per pass.
    CoreSets,
    /// The same bytes for any number of threads.
    Threads,
}

/// Generated points.
#[derive(Clone, Copy)]
pub(super) struct PointsCase {
    /// From what they are drawn.
    pub(super) distribution: Distribution,
    /// How many.
    pub(super) n: usize,
    /// Their dimension.
    pub(super) d: usize,
    /// Whether taut is given single precision (peers then take no part).
    pub(super) single: bool,
    /// Peers beside taut, by program name.
    pub(super) peers: &'static [&'static str],
}

/// Balls with normal centers, under each of the six radius laws.
#[derive(Clone, Copy)]
pub(super) struct BallsCase {
    /// How many.
    pub(super) n: usize,
    /// Dimension of their centers.
    pub(super) d: usize,
    /// Peers beside taut.
    pub(super) peers: &'static [&'static str],
}

/// The code of Fischer, Gärtner and Kutz, in two builds.
pub(super) const FGK: &[&str] = &["fgk-native", "fgk-o2"];

const fn points(
    distribution: Distribution,
    n: usize,
    d: usize,
    peers: &'static [&'static str],
) -> Kind {
    Kind::Points(PointsCase { distribution, n, d, single: false, peers })
}

const fn balls(n: usize, d: usize, peers: &'static [&'static str]) -> Kind {
    Kind::Balls(BallsCase { n, d, peers })
}

/// No budget was used up.
const CONVERGED: Goal = BUDGET_STOPS.at_most(0.0);
const GAP_GOAL: Goal = GAP.at_most(1e-12);
/// Half the diagonals of cubes, √d / 2, by dimension, to 1e-12.
const fn half_diagonal(radius: f64) -> Goal {
    RADIUS.near(radius, 1e-12)
}

const NOISE: Distribution = Distribution::Shell { thickness: 1e-8 };

/// All sections; the longest is the last.
pub(super) const AREA: Area<Kind> = Area {
    name: "ball",
    runs: 9,
    threads: &[1, 2],
    limit: 60,
    peer_budget: 120,
    sections: &[
        section(
            "small",
            points(
                Distribution::Normal,
                1000,
                3,
                &[
                    "fgk-o2",
                    "gaertner-o2",
                    "cgal-spheres-3-o2",
                    "cgal-min-sphere-3-o2",
                    "cyminiball",
                    "miniball-pypi",
                    "miniball-crate",
                ],
            ),
        )
        .about("Normal, 1000 × 3: every peer there is.")
        .must(&[GAP_GOAL]),
        section("usps", Kind::Usps)
            .about("USPS train, 7291 × 256, exact.")
            .must(&[RADIUS.near(13.479343686, 7e-10), GAP_GOAL]),
        section("normal-300", points(Distribution::Normal, 10_000, 300, FGK))
            .about("Normal, 10⁴ × 300, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(50.0).beside(FGK)])
            .aim(&[FASTER.at_least(200.0).beside(FGK)]),
        section("normal-500", points(Distribution::Normal, 10_000, 500, FGK))
            .about("Normal, 10⁴ × 500, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(50.0).beside(FGK)])
            .aim(&[FASTER.at_least(270.0).beside(FGK)]),
        section("normal-1000", points(Distribution::Normal, 10_000, 1000, FGK))
            .about("Normal, 10⁴ × 1000, exact, beside the Fischer–Gärtner–Kutz code.")
            .must(&[GAP_GOAL, FASTER.at_least(50.0).beside(FGK)])
            .aim(&[FASTER.at_least(400.0).beside(FGK)]),
        section("cube-100", points(Distribution::CubeVertices, 10_000, 100, FGK))
            .about("Vertices of the cube, 10⁴ × 100: cospherical, with r = √100 / 2.")
            .must(&[half_diagonal(5.0), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        section("cube-300", points(Distribution::CubeVertices, 10_000, 300, FGK))
            .about("Vertices of the cube, 10⁴ × 300: r = √300 / 2.")
            .must(&[half_diagonal(8.660254037844387), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        section("cube-500", points(Distribution::CubeVertices, 5_000, 500, FGK))
            .about("Vertices of the cube, 5000 × 500: r = √500 / 2.")
            .must(&[half_diagonal(11.180339887498949), GAP_GOAL, CONVERGED, SECONDS.at_most(0.3)])
            .aim(&[SECONDS.at_most(0.06)]),
        section("cube-1500", points(Distribution::CubeVertices, 20_000, 1500, &[]))
            .about("Vertices of the cube, 2·10⁴ × 1500: r = √1500 / 2.")
            .must(&[half_diagonal(19.364916731037084), GAP_GOAL, CONVERGED, SECONDS.at_most(5.0)]),
        section("shell-300", points(NOISE, 10_000, 300, FGK))
            .about("A sphere with noise of 1e-8, 10⁴ × 300: the hardest family.")
            .must(&[GAP_GOAL, CONVERGED, SECONDS.at_most(10.0)])
            .aim(&[SECONDS.at_most(1.0)]),
        section("shell-500", points(NOISE, 10_000, 500, &[]))
            .about("A sphere with noise of 1e-8, 10⁴ × 500.")
            .must(&[GAP_GOAL, CONVERGED, SECONDS.at_most(10.0)])
            .aim(&[SECONDS.at_most(1.0)]),
        section(
            "large",
            Kind::Points(PointsCase {
                distribution: Distribution::Normal,
                n: 100_000,
                d: 1500,
                single: true,
                peers: &[],
            }),
        )
        .about(
            "The largest instance of the thesis, normal 10⁵ × 1500 in single precision, \
                 exact, beside plain reads.",
        )
        .must(&[GAP_GOAL, PASSES.at_most(5.0), READS.at_most(10.0)])
        .aim(&[READS.at_most(5.0)]),
        section(
            "plane",
            points(
                Distribution::Normal,
                1_000_000,
                2,
                &["cgal-spheres-2-native", "cgal-min-sphere-2-native", "miniball-crate"],
            ),
        )
        .about("Normal, 10⁶ × 2, exact, beside CGAL.")
        .must(&[GAP_GOAL, PLANE_THIRD])
        .aim(&[SHARE.at_most(0.1).beside(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"])]),
        section(
            "space",
            points(
                Distribution::Normal,
                1_000_000,
                3,
                &["cgal-spheres-3-native", "cgal-min-sphere-3-native", "miniball-crate"],
            ),
        )
        .about("Normal, 10⁶ × 3, exact, beside CGAL.")
        .must(&[GAP_GOAL, SPACE_THIRD])
        .aim(&[SHARE.at_most(0.1).beside(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"])]),
        section("ten", points(Distribution::Normal, 1_000_000, 10, &["cgal-spheres-10-native"]))
            .about("Normal, 10⁶ × 10, exact, beside CGAL.")
            .must(&[GAP_GOAL, SHARE.at_most(1.0 / 3.0).beside(&["cgal-spheres-10-native"])])
            .aim(&[SHARE.at_most(0.1).beside(&["cgal-spheres-10-native"])]),
        section("file", Kind::File)
            .about(
                "Normal, 10⁶ × 2500 in single precision, in a file of 10 GB, beside `cat FILE \
                 > /dev/null`.",
            )
            .must(&[
                GAP_GOAL,
                PASSES.at_most(8.0),
                MEMORY.at_most((1 << 30) as f64),
                OF_CAT.at_least(0.8),
            ]),
        section("balls-3", balls(10_000, 3, &["cgal-balls-3-native"]))
            .about("10⁴ balls in ℝ³ under six radius laws, beside CGAL.")
            .must(&[GAP_GOAL, UNEXPLAINED.at_most(0.0).beside(&["cgal-balls-3-native"])]),
        section("balls-10", balls(10_000, 10, &["cgal-balls-10-native"]))
            .about("10⁴ balls in ℝ¹⁰ under six radius laws, beside CGAL.")
            .must(&[GAP_GOAL, UNEXPLAINED.at_most(0.0).beside(&["cgal-balls-10-native"])]),
        section("balls-100", balls(10_000, 100, &[]))
            .about("10⁴ balls in ℝ¹⁰⁰ under six radius laws.")
            .must(&[GAP_GOAL]),
        section("balls-300", balls(10_000, 300, &[]))
            .about("10⁴ balls in ℝ³⁰⁰ under six radius laws.")
            .must(&[GAP_GOAL]),
        section("balls-1000", balls(100_000, 1000, &[]))
            .about("10⁵ balls in ℝ¹⁰⁰⁰ under six radius laws, beside plain reads.")
            .must(&[GAP_GOAL, READS.at_most(20.0)]),
        section("core-sets", Kind::CoreSets).about(
            "Core-set sizes at ε = 1e-3 with one far point per pass, as the thesis counts \
                 them (figures 8, 10, 12).",
        ),
        section("threads", Kind::Threads)
            .about("Whole answers as JSON, byte for byte, for 1, 2 and 8 threads."),
    ],
};

const PLANE_THIRD: Goal =
    SHARE.at_most(1.0 / 3.0).beside(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"]);
const SPACE_THIRD: Goal =
    SHARE.at_most(1.0 / 3.0).beside(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"]);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_goals_speak_of_peers_that_run() {
        assert!(AREA.has_unique_names());
        for case in AREA.sections {
            let Kind::Points(points) = &case.kind else { continue };
            for goal in case.must.iter().chain(case.aim) {
                assert!(goal.peers.iter().all(|peer| points.peers.contains(peer)), "{}", case.name);
            }
        }
    }
}
