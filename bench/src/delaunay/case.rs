//! The list of cases: which inputs, beside whom, and what has to be reached.

use super::*;

pub(super) const OF_CGAL: Quantity =
    Quantity::new("processor time of one thread over CGAL's", Unit::Times);
pub(super) const OF_UNIFORM: Quantity =
    Quantity::new("processor time per point over that of a uniform set of this size", Unit::Times);
/// Of the peak, with any number of threads.
pub(super) const BYTES: Quantity = Quantity::new("bytes per point above the input", Unit::Fixed(1));
pub(super) const EXACT_RATE: Quantity =
    Quantity::new("share of predicates decided exactly", Unit::Power);
/// With one thread.
pub(super) const CHECK: Quantity =
    Quantity::new("processor time of the check over that of the build", Unit::Times);
/// By the clock, in the median of all rounds.
pub(super) const SPEEDUP: Quantity =
    Quantity::new("time of one thread over that of two", Unit::Times);

/// What is triangulated, by whom.
#[derive(Clone, Copy)]
pub(crate) struct Case {
    /// Dimension of its inputs.
    pub(super) dim: usize,
    pub(super) inputs: &'static [Input],
    /// Peers beside taut.
    pub(super) peers: &'static [&'static str],
    /// Numbers of threads taut is run with.
    pub(super) threads: &'static [usize],
}

/// Inputs in so many dimensions, beside CGAL, with one thread.
const fn case(dim: usize, inputs: &'static [Input]) -> Case {
    Case { dim, inputs, peers: &[CGAL], threads: &[1] }
}

impl Case {
    const fn peers(self, peers: &'static [&'static str]) -> Self {
        Case { peers, ..self }
    }

    const fn threads(self, threads: &'static [usize]) -> Self {
        Case { threads, ..self }
    }
}

/// One set of points.
#[derive(Clone, Copy)]
pub(super) struct Input {
    /// From what they are drawn, as `taut generate` calls it.
    pub(super) distribution: &'static str,
    /// Degrees by which a grid is turned.
    angle: Option<f64>,
    /// How many.
    pub(super) n: usize,
    /// How many simplices they have: of CGAL, and for skew lines and the fan by a formula.
    pub(super) simplices: u64,
    /// What has to be reached.
    pub(super) must: &'static [Goal],
    /// What is hoped for.
    pub(super) aim: &'static [Goal],
}

impl Input {
    /// The distribution, for `n` points.
    pub(super) fn distribution(&self, n: usize, dim: usize) -> Result<Distribution, Error> {
        let given = Parameters { angle: self.angle, ..Parameters::default() };
        Distribution::named(self.distribution, n as u64, dim, &given)
    }

    const fn goals(self, must: &'static [Goal], aim: &'static [Goal]) -> Self {
        Input { must, aim, ..self }
    }
}

const fn input(distribution: &'static str, n: usize, simplices: u64) -> Input {
    Input { distribution, angle: None, n, simplices, must: &[], aim: &[] }
}

/// The angle in degrees at which a floating in-circle test is known to fail on grids.
const FAILING_ANGLE: f64 = 302.328;

/// All peers in the plane.
pub(super) const PLANE_PEERS: &[&str] = &[CGAL, SPADE, DELAUNATOR, TRIANGLE, QHULL];
/// All peers in space.
pub(super) const SPACE_PEERS: &[&str] = &[CGAL, QHULL];

const PLANE_MUST: &[Goal] = &[OF_CGAL.at_most(0.55), CHECK.at_most(0.5)];
const PLANE_AIM: &[Goal] = &[OF_CGAL.at_most(0.38)];
const SPACE_MUST: &[Goal] = &[OF_CGAL.at_most(0.6), CHECK.at_most(0.5)];
const SPACE_AIM: &[Goal] = &[OF_CGAL.at_most(0.37)];
const NEVER_SLOWER: &[Goal] = &[SPEEDUP.at_least(1.0)];
const FASTER: &[Goal] = &[SPEEDUP.at_least(1.3)];
const CLIFF_GOALS: &[Goal] = &[OF_UNIFORM.at_most(2.0), CHECK.at_most(0.5)];

/// All sections.
pub(crate) const AREA: Area<Case> = Area {
    name: "delaunay",
    runs: 5,
    // Those of the section.
    threads: &[],
    limit: 120,
    peer_budget: 30,
    sections: &[
        section(
            "plane",
            case(
                2,
                &[
                    input("uniform", 1_000_000, 1_999_968).goals(
                        &[OF_CGAL.at_most(0.55), EXACT_RATE.at_most(1e-4), CHECK.at_most(0.5)],
                        PLANE_AIM,
                    ),
                    input("normal", 1_000_000, 1_999_983).goals(PLANE_MUST, PLANE_AIM),
                    input("clouds", 1_000_000, 1_999_973).goals(PLANE_MUST, PLANE_AIM),
                    input("kuzmin", 1_000_000, 1_999_991)
                        .goals(&[OF_CGAL.at_most(0.65), CHECK.at_most(0.5)], PLANE_AIM),
                    input("roads", 1_000_000, 1_999_980).goals(PLANE_MUST, PLANE_AIM),
                ],
            )
            .peers(PLANE_PEERS),
        )
        .about("A million points of the plane, one thread."),
        section(
            "plane-large",
            case(
                2,
                &[input("uniform", 10_000_000, 19_999_955)
                    .goals(&[OF_CGAL.at_most(0.5), CHECK.at_most(0.5)], PLANE_AIM)],
            )
            .peers(&[CGAL, SPADE, DELAUNATOR]),
        )
        .about("Ten million points of the plane, one thread."),
        section(
            "plane-cliffs",
            case(
                2,
                &[
                    input("uniform", 100_000, 199_962),
                    input("uniform", 1_000_000, 1_999_968),
                    input("grid", 1_000_000, 1_996_002).goals(CLIFF_GOALS, &[]),
                    Input { angle: Some(FAILING_ANGLE), ..input("grid", 1_000_000, 1_999_974) }
                        .goals(CLIFF_GOALS, &[]),
                    input("sphere", 100_000, 99_998).goals(CLIFF_GOALS, &[]),
                    input("roads", 1_000_000, 1_999_980).goals(CLIFF_GOALS, &[]),
                    input("lines", 1_000_000, 999_998).goals(CLIFF_GOALS, &[]),
                    input("spiral", 1_000_000, 1_822_953).goals(CLIFF_GOALS, &[]),
                    input("fan", 1_000_000, 999_998).goals(CLIFF_GOALS, &[]),
                ],
            )
            .peers(&[CGAL, SPADE, DELAUNATOR, TRIANGLE]),
        )
        .about(
            "Ties, lines and circles in the plane: no point may cost more than two of a \
                 uniform set of that size.",
        ),
        section(
            "space",
            case(
                3,
                &[
                    input("uniform", 1_000_000, 6_749_316).goals(
                        &[OF_CGAL.at_most(0.6), EXACT_RATE.at_most(1e-4), CHECK.at_most(0.5)],
                        SPACE_AIM,
                    ),
                    input("normal", 1_000_000, 6_765_494).goals(SPACE_MUST, SPACE_AIM),
                    input("clouds", 1_000_000, 6_688_990).goals(SPACE_MUST, SPACE_AIM),
                ],
            )
            .peers(SPACE_PEERS),
        )
        .about("A million points of space, one thread."),
        section(
            "space-grid",
            case(
                3,
                &[input("grid", 1_000_000, 5_821_794).goals(SPACE_MUST, &[OF_CGAL.at_most(0.4)])],
            ),
        )
        .about("The integer grid 100³: all ties; its tetrahedra are 6·99³."),
        section(
            "space-surfaces",
            case(
                3,
                &[
                    input("torus", 1_000_000, 6_117_584).goals(SPACE_MUST, &[OF_CGAL.at_most(0.4)]),
                    input("sphere", 100_000, 302_075).goals(
                        &[OF_CGAL.at_most(0.5), CHECK.at_most(0.5)],
                        &[OF_CGAL.at_most(0.27)],
                    ),
                    input("skew", 4_000, 1_999 * 1_999),
                ],
            ),
        )
        .about(
            "Points on surfaces and lines in space: cospherical, nearly cospherical, and \
                 as many tetrahedra as can be.",
        ),
        section(
            "threads-plane",
            case(
                2,
                &[
                    input("uniform", 10_000_000, 19_999_955)
                        .goals(&[SPEEDUP.at_least(1.65)], &[SPEEDUP.at_least(1.85)]),
                    input("uniform", 1_000_000, 1_999_968)
                        .goals(&[SPEEDUP.at_least(1.5)], &[SPEEDUP.at_least(1.75)]),
                    input("sphere", 1_000_000, 999_998)
                        .goals(&[SPEEDUP.at_least(1.4)], &[SPEEDUP.at_least(1.7)]),
                    input("kuzmin", 1_000_000, 1_999_991).goals(NEVER_SLOWER, FASTER),
                    input("roads", 1_000_000, 1_999_980).goals(NEVER_SLOWER, FASTER),
                    input("grid", 1_000_000, 1_996_002).goals(NEVER_SLOWER, FASTER),
                    input("lines", 1_000_000, 999_998).goals(NEVER_SLOWER, FASTER),
                    input("spiral", 1_000_000, 1_822_953).goals(NEVER_SLOWER, FASTER),
                    input("fan", 1_000_000, 999_998).goals(NEVER_SLOWER, FASTER),
                ],
            )
            .peers(&[])
            .threads(&[1, 2]),
        )
        .about("Points of the plane, one thread and two."),
        section(
            "threads-space",
            case(
                3,
                &[
                    input("uniform", 1_000_000, 6_749_316)
                        .goals(&[SPEEDUP.at_least(1.6)], &[SPEEDUP.at_least(1.8)]),
                    input("grid", 1_000_000, 5_821_794)
                        .goals(&[SPEEDUP.at_least(1.6)], &[SPEEDUP.at_least(1.8)]),
                    input("torus", 1_000_000, 6_117_584)
                        .goals(&[SPEEDUP.at_least(1.45)], &[SPEEDUP.at_least(1.8)]),
                    input("sphere", 100_000, 302_075).goals(NEVER_SLOWER, FASTER),
                ],
            )
            .peers(&[])
            .threads(&[1, 2]),
        )
        .about("Points of space, one thread and two."),
        section(
            "memory-plane",
            case(
                2,
                &[
                    input("uniform", 1_000_000, 1_999_968)
                        .goals(&[BYTES.at_most(78.0)], &[BYTES.at_most(72.0)]),
                    input("uniform", 10_000_000, 19_999_955)
                        .goals(&[BYTES.at_most(78.0)], &[BYTES.at_most(72.0)]),
                ],
            )
            .peers(&[CGAL, SPADE, DELAUNATOR])
            .threads(&[1, 2]),
        )
        .about("Peak memory above the input in the plane."),
        section(
            "memory-space",
            case(
                3,
                &[
                    input("uniform", 1_000_000, 6_749_316)
                        .goals(&[BYTES.at_most(275.0)], &[BYTES.at_most(266.0)]),
                    input("torus", 1_000_000, 6_117_584)
                        .goals(&[BYTES.at_most(275.0)], &[BYTES.at_most(266.0)]),
                ],
            )
            .threads(&[1, 2]),
        )
        .about("Peak memory above the input in space."),
    ],
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_inputs_can_be_drawn() {
        for Section { name, kind: case, .. } in AREA.sections {
            for input in case.inputs {
                let distribution = input.distribution(input.n, case.dim).unwrap();
                assert!(distribution.to_string().starts_with(input.distribution));
                let cells = match distribution {
                    Distribution::Grid { side, .. } => side.pow(case.dim as u32),
                    _ => input.n as u64,
                };
                assert_eq!(cells, input.n as u64, "{name}: the whole grid");
            }
        }
    }

    #[test]
    fn the_same_points_have_the_same_number_of_simplices_in_every_case() {
        let mut known: Vec<(String, u64)> = Vec::new();
        for Section { kind: case, .. } in AREA.sections {
            for input in case.inputs {
                let what =
                    format!("{} {:?} {} {}", input.distribution, input.angle, input.n, case.dim);
                match known.iter().find(|(other, _)| *other == what) {
                    Some((_, simplices)) => assert_eq!(*simplices, input.simplices, "{what}"),
                    None => known.push((what, input.simplices)),
                }
                if case.dim == 2 {
                    // 2n − 2 − h with h from 3 to n points on the hull.
                    let n = input.n as u64;
                    assert!(
                        (n - 2..=2 * n - 5).contains(&input.simplices),
                        "{}",
                        input.distribution
                    );
                }
            }
        }
    }
}
