//! The list of cases.

use taut_points::Distribution;

use super::goals::{CONVERGED, faster, judged, reads, share, share_of_cat};
use crate::cases::Named;
use crate::goals::Goal;

/// A case by name.
pub(super) struct Case {
    /// Its name on the command line.
    pub(super) name: &'static str,
    /// What it shows.
    pub(super) about: &'static str,
    /// What is done.
    pub(super) kind: Kind,
    /// What has to be reached.
    pub(super) must: &'static [Goal],
    /// What is hoped for.
    pub(super) aim: &'static [Goal],
}

impl Named for Case {
    fn head(&self) -> [&'static str; 2] {
        [self.name, self.about]
    }
}

/// What is done in a case.
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

/// Balls with normal centres, under each of the six radius laws.
pub(super) struct BallsCase {
    /// How many.
    pub(super) n: usize,
    /// Dimension of their centres.
    pub(super) d: usize,
    /// Peers beside taut.
    pub(super) peers: &'static [&'static str],
}

const FGK: &[&str] = &["fgk-native", "fgk-o2"];

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

const GAP_GOAL: Goal = Goal::gap(1e-12);
/// Half the diagonals of cubes, √d / 2, by dimension, to 1e-12.
const fn half_diagonal(radius: f64) -> Goal {
    Goal::radius(radius, 1e-12)
}

const NOISE: Distribution = Distribution::Shell { thickness: 1e-8 };

/// All cases, in the order in which they run.
pub(super) const CASES: &[Case] = &[
    Case {
        name: "small",
        about: "Normal, 1000 × 3: every peer there is.",
        kind: points(
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
        must: &[GAP_GOAL],
        aim: &[],
    },
    Case {
        name: "usps",
        about: "USPS train, 7291 × 256, exact.",
        kind: Kind::Usps,
        must: &[Goal::radius(13.479343686, 7e-10), GAP_GOAL],
        aim: &[],
    },
    Case {
        name: "normal-300",
        about: "Normal, 10⁴ × 300, exact, beside the Fischer–Gärtner–Kutz code.",
        kind: points(Distribution::Normal, 10_000, 300, FGK),
        must: &[GAP_GOAL, faster(FGK, 50.0)],
        aim: &[faster(FGK, 200.0)],
    },
    Case {
        name: "normal-500",
        about: "Normal, 10⁴ × 500, exact, beside the Fischer–Gärtner–Kutz code.",
        kind: points(Distribution::Normal, 10_000, 500, FGK),
        must: &[GAP_GOAL, faster(FGK, 50.0)],
        aim: &[faster(FGK, 270.0)],
    },
    Case {
        name: "normal-1000",
        about: "Normal, 10⁴ × 1000, exact, beside the Fischer–Gärtner–Kutz code.",
        kind: points(Distribution::Normal, 10_000, 1000, FGK),
        must: &[GAP_GOAL, faster(FGK, 50.0)],
        aim: &[faster(FGK, 400.0)],
    },
    Case {
        name: "cube-100",
        about: "Vertices of the cube, 10⁴ × 100: cospherical, with r = √100 / 2.",
        kind: points(Distribution::CubeVertices, 10_000, 100, FGK),
        must: &[half_diagonal(5.0), GAP_GOAL, CONVERGED, Goal::seconds(0.3)],
        aim: &[Goal::seconds(0.06)],
    },
    Case {
        name: "cube-300",
        about: "Vertices of the cube, 10⁴ × 300: r = √300 / 2.",
        kind: points(Distribution::CubeVertices, 10_000, 300, FGK),
        must: &[half_diagonal(8.660254037844387), GAP_GOAL, CONVERGED, Goal::seconds(0.3)],
        aim: &[Goal::seconds(0.06)],
    },
    Case {
        name: "cube-500",
        about: "Vertices of the cube, 5000 × 500: r = √500 / 2.",
        kind: points(Distribution::CubeVertices, 5_000, 500, FGK),
        must: &[half_diagonal(11.180339887498949), GAP_GOAL, CONVERGED, Goal::seconds(0.3)],
        aim: &[Goal::seconds(0.06)],
    },
    Case {
        name: "cube-1500",
        about: "Vertices of the cube, 2·10⁴ × 1500: r = √1500 / 2.",
        kind: points(Distribution::CubeVertices, 20_000, 1500, &[]),
        must: &[half_diagonal(19.364916731037084), GAP_GOAL, CONVERGED, Goal::seconds(5.0)],
        aim: &[],
    },
    Case {
        name: "shell-300",
        about: "A sphere with noise of 1e-8, 10⁴ × 300: the hardest family.",
        kind: points(NOISE, 10_000, 300, FGK),
        must: &[GAP_GOAL, CONVERGED, Goal::seconds(10.0)],
        aim: &[Goal::seconds(1.0)],
    },
    Case {
        name: "shell-500",
        about: "A sphere with noise of 1e-8, 10⁴ × 500.",
        kind: points(NOISE, 10_000, 500, &[]),
        must: &[GAP_GOAL, CONVERGED, Goal::seconds(10.0)],
        aim: &[Goal::seconds(1.0)],
    },
    Case {
        name: "large",
        about: "The largest instance of the thesis, normal 10⁵ × 1500 in single precision, exact, beside plain reads.",
        kind: Kind::Points(PointsCase {
            distribution: Distribution::Normal,
            n: 100_000,
            d: 1500,
            single: true,
            peers: &[],
        }),
        must: &[GAP_GOAL, Goal::passes(5), reads(10.0)],
        aim: &[reads(5.0)],
    },
    Case {
        name: "plane",
        about: "Normal, 10⁶ × 2, exact, beside CGAL.",
        kind: points(
            Distribution::Normal,
            1_000_000,
            2,
            &["cgal-spheres-2-native", "cgal-min-sphere-2-native", "miniball-crate"],
        ),
        must: &[GAP_GOAL, PLANE_THIRD],
        aim: &[share(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"], 0.1)],
    },
    Case {
        name: "space",
        about: "Normal, 10⁶ × 3, exact, beside CGAL.",
        kind: points(
            Distribution::Normal,
            1_000_000,
            3,
            &["cgal-spheres-3-native", "cgal-min-sphere-3-native", "miniball-crate"],
        ),
        must: &[GAP_GOAL, SPACE_THIRD],
        aim: &[share(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"], 0.1)],
    },
    Case {
        name: "ten",
        about: "Normal, 10⁶ × 10, exact, beside CGAL.",
        kind: points(Distribution::Normal, 1_000_000, 10, &["cgal-spheres-10-native"]),
        must: &[GAP_GOAL, share(&["cgal-spheres-10-native"], 1.0 / 3.0)],
        aim: &[share(&["cgal-spheres-10-native"], 0.1)],
    },
    Case {
        name: "file",
        about: "Normal, 10⁶ × 2500 in single precision, in a file of 10 GB, beside `cat FILE > /dev/null`.",
        kind: Kind::File,
        must: &[GAP_GOAL, Goal::passes(8), Goal::memory(1 << 30), share_of_cat(0.8)],
        aim: &[],
    },
    Case {
        name: "balls-3",
        about: "10⁴ balls in ℝ³ under six radius laws, beside CGAL.",
        kind: balls(10_000, 3, &["cgal-balls-3-native"]),
        must: &[GAP_GOAL, judged(&["cgal-balls-3-native"])],
        aim: &[],
    },
    Case {
        name: "balls-10",
        about: "10⁴ balls in ℝ¹⁰ under six radius laws, beside CGAL.",
        kind: balls(10_000, 10, &["cgal-balls-10-native"]),
        must: &[GAP_GOAL, judged(&["cgal-balls-10-native"])],
        aim: &[],
    },
    Case {
        name: "balls-100",
        about: "10⁴ balls in ℝ¹⁰⁰ under six radius laws.",
        kind: balls(10_000, 100, &[]),
        must: &[GAP_GOAL],
        aim: &[],
    },
    Case {
        name: "balls-300",
        about: "10⁴ balls in ℝ³⁰⁰ under six radius laws.",
        kind: balls(10_000, 300, &[]),
        must: &[GAP_GOAL],
        aim: &[],
    },
    Case {
        name: "balls-1000",
        about: "10⁵ balls in ℝ¹⁰⁰⁰ under six radius laws, beside plain reads.",
        kind: balls(100_000, 1000, &[]),
        must: &[GAP_GOAL, reads(20.0)],
        aim: &[],
    },
    Case {
        name: "core-sets",
        about: "Core-set sizes at ε = 1e-3 with one far point per pass, as the thesis counts them (figures 8, 10, 12).",
        kind: Kind::CoreSets,
        must: &[],
        aim: &[],
    },
    Case {
        name: "threads",
        about: "Whole answers as JSON, byte for byte, for 1, 2 and 8 threads.",
        kind: Kind::Threads,
        must: &[],
        aim: &[],
    },
];

const PLANE_THIRD: Goal = share(&["cgal-spheres-2-native", "cgal-min-sphere-2-native"], 1.0 / 3.0);
const SPACE_THIRD: Goal = share(&["cgal-spheres-3-native", "cgal-min-sphere-3-native"], 1.0 / 3.0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_goals_speak_of_peers_that_run() {
        for (at, case) in CASES.iter().enumerate() {
            assert!(CASES[..at].iter().all(|other| other.name != case.name), "{}", case.name);
            let Kind::Points(points) = &case.kind else { continue };
            for goal in case.must.iter().chain(case.aim) {
                assert!(goal.peers.iter().all(|peer| points.peers.contains(peer)), "{}", case.name);
            }
        }
    }
}
