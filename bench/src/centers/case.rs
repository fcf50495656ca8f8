//! The list of cases: which inputs, and what has to be reached.

use super::*;

/// What is done in a section.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// Free centers of points, to a gap.
    Free(&'static [Task]),
    /// Centers among the points, beside a set-cover program.
    Discrete,
    /// Farthest-first traversals of many points.
    Traversal,
    /// Centers of all but a few points.
    Outliers,
    /// Points that come by once.
    Streams,
}

/// Points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Set {
    /// The cities of a file of `$TAUT_DATA/ball`.
    Cities(&'static str),
    /// So many normal points of space.
    Normal(usize),
}

/// The cities of Germany.
pub(super) const GERMANY: Set = Set::Cities("d15112.tsp.xz");
const USA: Set = Set::Cities("usa13509.xy.xz");
const SPACE: Set = Set::Normal(10_000);

/// So many centers, to such a gap, and what has to be reached.
pub(super) struct Task {
    /// The points.
    pub(super) set: Set,
    /// Number of centers.
    pub(super) k: usize,
    /// Relative gap asked for.
    pub(super) epsilon: f64,
    /// Most permutations, where one takes minutes.
    pub(super) permutations: usize,
    /// What has to be reached, beside the gap.
    pub(super) must: &'static [Goal],
    /// What is hoped for.
    pub(super) aim: &'static [Goal],
}

const fn task(set: Set, k: usize, epsilon: f64) -> Task {
    Task { set, k, epsilon, permutations: usize::MAX, must: &[], aim: &[] }
}

impl Task {
    const fn must(self, must: &'static [Goal]) -> Self {
        Task { must, ..self }
    }

    const fn aim(self, aim: &'static [Goal]) -> Self {
        Task { aim, ..self }
    }

    const fn once(self) -> Self {
        Task { permutations: 1, ..self }
    }
}

const GAP_EXACT: f64 = 1e-6;
const SECONDS_GOAL: Goal = SECONDS.at_most(0.3);
const QUICK_AIM: &[Goal] = &[SECONDS.at_most(0.05)];
const CORE_SET_GOAL: Goal = CORE_SET.at_most(200.0);
const CHECK_GOAL: Goal = CHECK.at_most(1.0);

/// All sections; the longest is the last.
pub(super) const AREA: Area<Kind> = Area {
    name: "centers",
    runs: 5,
    threads: &[1, 2],
    limit: 120,
    peer_budget: 600,
    sections: &[
        section(
            "cities",
            Kind::Free(&[
                task(GERMANY, 2, GAP_EXACT)
                    .must(&[
                        RADIUS.near(9342.60196519, KNOWN_RADIUS_TOLERANCE),
                        SECONDS_GOAL,
                        CORE_SET_GOAL,
                        CHECK_GOAL,
                    ])
                    .aim(QUICK_AIM),
                task(GERMANY, 3, GAP_EXACT)
                    .must(&[
                        RADIUS.near(8139.66296907, KNOWN_RADIUS_TOLERANCE),
                        SECONDS_GOAL,
                        CORE_SET_GOAL,
                        CHECK_GOAL,
                    ])
                    .aim(QUICK_AIM),
                task(GERMANY, 4, GAP_EXACT)
                    .must(&[
                        RADIUS.near(6573.74826488, KNOWN_RADIUS_TOLERANCE),
                        SECONDS_GOAL,
                        CORE_SET_GOAL,
                        CHECK_GOAL,
                    ])
                    .aim(QUICK_AIM),
                task(GERMANY, 5, GAP_EXACT)
                    .must(&[
                        RADIUS.near(5818.46791619, KNOWN_RADIUS_TOLERANCE),
                        SECONDS_GOAL,
                        CORE_SET_GOAL,
                        CHECK_GOAL,
                    ])
                    .aim(QUICK_AIM),
                task(GERMANY, 8, GAP_EXACT)
                    .must(&[
                        RADIUS.near(4306.44830458, KNOWN_RADIUS_TOLERANCE),
                        SECONDS.at_most(2.0),
                        CORE_SET_GOAL,
                        CHECK_GOAL,
                    ])
                    .aim(&[SECONDS.at_most(0.1)]),
                task(GERMANY, 10, GAP_EXACT)
                    .must(&[
                        RADIUS.near(3725.69052411, KNOWN_RADIUS_TOLERANCE),
                        SECONDS.at_most(10.0),
                    ])
                    .aim(&[SECONDS.at_most(1.0)]),
                task(GERMANY, 12, GAP_EXACT)
                    .must(&[SECONDS.at_most(60.0)])
                    .aim(&[SECONDS.at_most(5.0)]),
                task(USA, 5, GAP_EXACT).must(&[
                    RADIUS.near(99986.80259875, KNOWN_RADIUS_TOLERANCE),
                    SECONDS.at_most(0.2),
                    CORE_SET_GOAL,
                    CHECK_GOAL,
                ]),
                task(USA, 10, GAP_EXACT).must(&[
                    RADIUS.near(65210.68259879, KNOWN_RADIUS_TOLERANCE),
                    SECONDS.at_most(4.0),
                ]),
            ]),
        )
        .about(
            "Cities of Germany and of the USA, free centers at ε = 1e-6, beside the \
                 optima that are known.",
        ),
        section(
            "cities-15",
            Kind::Free(&[
                task(GERMANY, 15, 0.01)
                    .must(&[SECONDS.at_most(300.0)])
                    .aim(&[SECONDS.at_most(10.0)]),
                task(USA, 15, 0.01).must(&[SECONDS.at_most(100.0)]).aim(&[SECONDS.at_most(4.0)]),
            ]),
        )
        .about("The same for k = 15, at 1 %."),
        section(
            "space",
            Kind::Free(&[
                task(SPACE, 4, 0.01)
                    .must(&[SECONDS.at_most(0.1), CORE_SET_GOAL])
                    .aim(&[SECONDS.at_most(0.01)]),
                task(SPACE, 6, 0.01)
                    .must(&[SECONDS.at_most(0.3), CORE_SET_GOAL])
                    .aim(&[SECONDS.at_most(0.03)]),
                task(SPACE, 8, 0.01)
                    .must(&[SECONDS.at_most(3.0), CORE_SET_GOAL])
                    .aim(&[SECONDS.at_most(0.2)]),
                task(SPACE, 10, 0.01).must(&[SECONDS.at_most(40.0)]).aim(&[SECONDS.at_most(2.0)]),
            ]),
        )
        .about("Normal, 10⁴ × 3, free centers at 1 %: the thesis needed almost a week for four."),
        section("discrete", Kind::Discrete)
            .about(
                "Centers among the points, exact: 200 small sets beside set-cover programs \
                 under HiGHS, and the cities of Germany.",
            )
            .must(&[GAP.at_most(1e-11), DIFFERS.at_most(1e-12)]),
        section("farthest-first", Kind::Traversal)
            .about(
                "1000 points in farthest-first order, of 10⁷ × 3 in double and 10⁶ × 128 in \
                 single precision, beside NumPy.",
            )
            .must(&[BANDWIDTH.at_least(0.8), DIFFERS.at_most(1e-5)]),
        section("outliers", Kind::Outliers)
            .about("Uniform, 2000 × 2, without up to five points, at ε = 1e-6.")
            .must(&[GAP.at_most(GAP_EXACT)]),
        section("streams", Kind::Streams)
            .about(
                "Normal, 10⁶ × 3, one after another: the factor measured beside the one \
                 stated, on two orders.",
            )
            .must(&[FACTOR.at_most(1.0 + FACTOR_ROUNDING)]),
        section(
            "cities-20",
            Kind::Free(&[
                task(GERMANY, 20, 0.05).must(&[SECONDS.at_most(300.0)]).once(),
                task(GERMANY, 20, 0.01).aim(&[GAP.at_most(0.01), SECONDS.at_most(600.0)]).once(),
            ]),
        )
        .about("The cities of Germany for k = 20, at 5 % and at 1 %: minutes, one permutation."),
    ],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::goals::Direction;

    #[test]
    fn names_are_unique_and_every_case_has_a_goal() {
        assert!(AREA.has_unique_names());
        for case in AREA.sections {
            let has_goal = match case.kind {
                Kind::Free(tasks) => {
                    tasks.iter().all(|task| !task.must.is_empty() || !task.aim.is_empty())
                }
                _ => !case.must.is_empty(),
            };
            assert!(has_goal, "{}", case.name);
        }
    }

    #[test]
    fn more_centers_of_a_set_are_known_to_reach_less_far() {
        let radius = |goal: &Goal| match goal.direction {
            Direction::Near(radius) => Some(radius),
            _ => None,
        };
        for case in AREA.sections {
            let Kind::Free(tasks) = case.kind else { continue };
            for pair in tasks.windows(2).filter(|pair| pair[0].set == pair[1].set) {
                assert!(pair[0].k < pair[1].k || pair[0].epsilon > pair[1].epsilon);
                let [a, b] = [0, 1].map(|i| pair[i].must.iter().find_map(radius));
                assert!(a.zip(b).is_none_or(|(a, b)| a > b), "{}, k = {}", case.name, pair[1].k);
            }
        }
    }
}
